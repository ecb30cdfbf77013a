#include "base/csv.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "unit/base/temp_folder.h"

namespace pyroscene {
namespace {

CsvTable table_of(const std::string& text) {
    const TempFolder folder;
    write_text_file(folder / "table.csv", text);
    return read_csv(folder / "table.csv");
}

std::string message_of(const std::string& text) {
    try {
        table_of(text);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return {};
}

TEST(Csv, SkipsCommentsAndBlankLinesAndKeepsLineNumbers) {
    const CsvTable t = table_of("# origin: a paper\n\nname , value\r\n a , 1.5\r\n# more\nb,-2e3\n");
    EXPECT_EQ(t.columns, (std::vector<std::string>{"name", "value"}));
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.rows[0][0], "a");
    EXPECT_EQ(t.row_lines, (std::vector<int>{4, 6}));
    EXPECT_EQ(t.numbers("value"), (std::vector<double>{1.5, -2000.0}));
    EXPECT_TRUE(t.has("name"));
    EXPECT_FALSE(t.has("nam"));
}

TEST(Csv, KeepsEmptyFields) {
    const CsvTable t = table_of("a,b,c\n1,,\n");
    EXPECT_EQ(t.rows[0], (std::vector<std::string>{"1", "", ""}));
}

TEST(Csv, TakesQuotedFieldsWithCommasQuotesAndBlanks) {
    const CsvTable t = table_of("a,\"b, c\",d\n\"1,5\" , \" x \",\"\"\n2,\"say \"\"no\"\"\",3\n");
    EXPECT_EQ(t.columns, (std::vector<std::string>{"a", "b, c", "d"}));
    EXPECT_EQ(t.rows[0], (std::vector<std::string>{"1,5", " x ", ""}));
    EXPECT_EQ(t.rows[1], (std::vector<std::string>{"2", "say \"no\"", "3"}));
}

TEST(Csv, IgnoresAByteOrderMark) {
    EXPECT_EQ(table_of("\xEF\xBB\xBF"
                       "a,b\n1,2\n")
                  .columns[0],
              "a");
}

TEST(Csv, NamesFileLineAndColumnOfWhatIsWrong) {
    EXPECT_NE(message_of("a,b\n1,2\n1,2,3\n").find("table.csv:3: found 3 fields, expected 2"), std::string::npos);
    EXPECT_NE(message_of("a\n\"x\n").find("table.csv:2: a quoted field does not end"), std::string::npos);
    EXPECT_NE(message_of("a\n\"x\"y\n").find("table.csv:2: found 'y' after a quoted field"), std::string::npos);
    EXPECT_NE(message_of("# only a comment\n").find("empty"), std::string::npos);
    const CsvTable t = table_of("a,b\n1,2\n1,two\n");
    try {
        (void)t.numbers("b");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("table.csv:3: column 'b': expected a number, found 'two'"), std::string::npos);
    }
    try {
        (void)t.column("c");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("no column 'c'; the table has a, b"), std::string::npos);
    }
}

TEST(Csv, MissingFileIsAnInputError) { EXPECT_THROW(read_csv("/nonexistent/table.csv"), Error); }

TEST(ParseNumber, ReadsWholeStringsOnly) {
    EXPECT_EQ(parse_number(" +4.25e-1 ", "x"), 0.425);
    EXPECT_TRUE(std::isnan(parse_number("NaN", "x")));
    for (const char* bad : {"", " ", "1.0x", "1,5", "--1", "+-1", "0x10", "1 2"})
        EXPECT_THROW(parse_number(bad, "x"), Error) << bad;
}

}  // namespace
}  // namespace pyroscene
