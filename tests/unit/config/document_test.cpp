#include "config/yaml.h"

#include "yaml_file.h"

namespace pyroscene::config {

namespace {

/// What opening (and, if that works, throwing) says; empty when nothing is wrong.
std::string message_of(const std::filesystem::path& path) {
    try {
        Document(path).throw_if_any();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        return error.what();
    }
    return "";
}

}  // namespace

TEST(Document, MissingFileFolderAndEmptyFileAreInputErrors) {
    EXPECT_EQ(message_of("/nowhere/scenario.yaml"), "/nowhere/scenario.yaml: does not exist");
    EXPECT_NE(message_of(std::filesystem::temp_directory_path()).find("is a folder"), std::string::npos);
    const YamlFile empty("# nothing but a comment\n");
    EXPECT_EQ(message_of(empty.path()), empty.path().string() + ": is empty, expected YAML");
}

TEST(Document, SyntaxErrorsNameTheLine) {
    const YamlFile file("a: 1\nb: [1, 2\nc: 3\n");
    EXPECT_EQ(message_of(file.path()).rfind(file.path().string() + ":3: is no valid YAML: ", 0), 0U)
        << message_of(file.path());
    const YamlFile tab("a:\n\tb: 1\n");
    EXPECT_NE(message_of(tab.path()).find("is no valid YAML"), std::string::npos);
}

TEST(Document, RefusesSeveralDocuments) {
    const YamlFile file("a: 1\n---\nb: 2\n");
    EXPECT_NE(message_of(file.path()).find("several YAML documents"), std::string::npos);
}

TEST(Document, ReportsKeysGivenTwiceAtAnyDepth) {
    const YamlFile file("a: 1\nmap:\n  x: 1\n  y: 2\n  x: 3\nlist:\n  - {id: 1, id: 2}\na: 2\n");
    const Document document(file.path());
    EXPECT_EQ(texts(document), (Lines{"5 map: key 'x' is given twice (first in line 3)",
                                      "7 list[0]: key 'id' is given twice (first in line 7)",
                                      "8 : key 'a' is given twice (first in line 1)"}));
}

TEST(Document, RefusesKeysThatAreNoWords) {
    const YamlFile file("[1, 2]: 3\nb: 1\n");
    EXPECT_EQ(texts(Document(file.path())), Lines{"1 : a key must be a word, found a list"});
}

TEST(Document, RefusesAliasesThatContainThemselves) {
    const YamlFile file("a: &loop [*loop]\n");
    EXPECT_NE(message_of(file.path()), "");
}

TEST(Document, RefusesAliasesThatMultiply) {
    std::string text = "a0: &a0 [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n";
    for (int i = 1; i <= 9; ++i) {
        const std::string last = "*a" + std::to_string(i - 1);
        text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last + ", " + last + ", " + last + ", " +
                last + ", " + last + ", " + last + "]\n";
    }
    const YamlFile file(text);
    EXPECT_NE(message_of(file.path()).find("too deeply or too large"), std::string::npos);
}

TEST(Document, ThrowsAllProblemsSortedByLine) {
    const YamlFile file("a: x\nb: -1\nc: y\n");
    Document document(file.path());
    const std::string name = file.path().string();
    EXPECT_NO_THROW(document.throw_if_any());
    document.report(3, "c", "third");
    document.report(1, "a", "first");
    document.report(2, "", "second");
    document.report(1, "a", "first");  // said twice, shown once
    try {
        document.throw_if_any();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        EXPECT_EQ(std::string(error.what()),
                  name + ": 3 problems\n" + name + ":1: a: first\n" + name + ":2: second\n" + name + ":3: c: third");
    }
}

TEST(Document, OneProblemIsOneLine) {
    const YamlFile file("a: 1\n");
    Document document(file.path());
    document.report(0, "", "whole file");
    try {
        document.throw_if_any();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), file.path().string() + ": whole file");
    }
}

}  // namespace pyroscene::config
