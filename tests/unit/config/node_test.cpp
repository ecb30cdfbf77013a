#include "config/yaml.h"

#include "yaml_file.h"

namespace pyroscene::config {

TEST(Node, ReadsValuesAndDefaults) {
    const YamlFile file("number: 1e3\ninteger: -4\nflag: true\nword: hello\nlist: [1, 2.5, 3]\nsingle: 7\ndigits: 123\n");
    const Document document(file.path());
    const Node root = document.root();
    EXPECT_EQ(root.number("number", 0.0), 1000.0);
    EXPECT_EQ(root.integer("integer", 0), -4);
    EXPECT_TRUE(root.boolean("flag", false));
    EXPECT_EQ(root.text("word", ""), "hello");
    EXPECT_EQ(root.text("digits", ""), "123");
    EXPECT_EQ(root.numbers("list", 3), (std::vector<double>{1.0, 2.5, 3.0}));
    EXPECT_EQ(root.numbers("single"), std::vector<double>{7.0});
    EXPECT_EQ(root.number("absent", 2.5), 2.5);
    EXPECT_FALSE(root.optional_number("absent").has_value());
    EXPECT_EQ(root.optional_number("single"), 7.0);
    EXPECT_EQ(root.choice("absent_choice", "a", {"a", "b"}), "a");
    root.finish();
    EXPECT_EQ(texts(document), Lines{});
}

TEST(Node, WrongTypeIsReportedAndTheDefaultReturned) {
    const YamlFile file("a: 3 m\nb: abc\nc: [1]\nd: {x: 1}\ne: \"3\"\nf: yes\ng: 1.5\nh: [1, two]\ni: [1, 2]\nj: {k: 1}\n");
    const Document document(file.path());
    const Node root = document.root();
    EXPECT_EQ(root.number("a", -1.0), -1.0);
    EXPECT_EQ(root.number("b", -1.0), -1.0);
    EXPECT_EQ(root.number("c", -1.0), -1.0);
    EXPECT_EQ(root.text("d", "none"), "none");
    EXPECT_FALSE(root.optional_number("e").has_value());
    EXPECT_TRUE(root.boolean("f", true));
    EXPECT_EQ(root.integer("g", 9), 9);
    EXPECT_EQ(root.numbers("h"), std::vector<double>{});
    EXPECT_EQ(root.numbers("i", 3), std::vector<double>{});
    EXPECT_EQ(root.numbers("j"), std::vector<double>{});
    EXPECT_EQ(texts(document),
              (Lines{"1 a: expected a number, found '3 m' (a value carries no unit; the unit is in the key)",
                     "2 b: expected a number, found 'abc'", "3 c: expected a number, found a list",
                     "4 d: expected a text, found a map", "5 e: expected a number without quotes, found '3'",
                     "6 f: expected true or false, found 'yes'", "7 g: expected a whole number, found '1.5'",
                     "8 h[1]: expected a number, found 'two'", "9 i: expected a list of 3 numbers, found 2",
                     "10 j: expected a list of numbers, found a map"}));
}

TEST(Node, RangesAreChecked) {
    const YamlFile file("a: -1\nb: 0\nc: 500\nd: .inf\ne: .nan\nf: 17\n");
    const Document document(file.path());
    const Node root = document.root();
    EXPECT_EQ(root.number("a", 5.0, Range::not_negative()), 5.0);
    EXPECT_EQ(root.number("b", 5.0, Range::positive()), 5.0);
    EXPECT_EQ(root.number("c", 5.0, Range::between(1, 300)), 5.0);
    EXPECT_EQ(root.number("d", 5.0), 5.0);
    EXPECT_EQ(root.number("e", 5.0), 5.0);
    EXPECT_EQ(root.integer("f", 5, Range::between(1, 16)), 5);
    EXPECT_EQ(texts(document),
              (Lines{"1 a: must be >= 0, found -1", "2 b: must be > 0, found 0", "3 c: must be between 1 and 300, found 500",
                     "4 d: must be a finite number, found .inf", "5 e: must be a finite number, found .nan",
                     "6 f: must be between 1 and 16, found 17"}));
}

TEST(Node, ChoiceNamesTheWordsAndTheNearest) {
    const YamlFile file("colour: gren\nshape: 12345678\nlist: [red]\n");
    const Document document(file.path());
    EXPECT_EQ(document.root().choice("colour", "red", {"red", "green"}), "red");
    EXPECT_EQ(document.root().choice("shape", "round", {"round"}), "round");
    EXPECT_EQ(document.root().choice("list", "red", {"red", "green"}), "red");
    EXPECT_EQ(texts(document),
              (Lines{"1 colour: 'gren' is none of red, green; did you mean 'green'?", "2 shape: '12345678' is none of round",
                     "3 list: expected one of red, green, found a list"}));
}

TEST(Node, UnknownKeysAreReportedWithTheNearestKnownOne) {
    const YamlFile file("terrain: 1\nheat_fluxx: 2\nzzzzzzzz: 3\nnote: free\n");
    const Document document(file.path());
    const Node root = document.root();
    EXPECT_EQ(root.number("terrain", 0.0), 1.0);
    EXPECT_EQ(root.number("heat_flux", 0.0), 0.0);
    root.ignore("note");
    root.finish();
    EXPECT_EQ(texts(document), (Lines{"2 : unknown key 'heat_fluxx'; did you mean 'heat_flux'?",
                                      "3 : unknown key 'zzzzzzzz'; known here: heat_flux, note, terrain"}));
}

TEST(Node, NodesAskedForTwiceShareWhatIsKnown) {
    const YamlFile file("map: {a: 1, b: 2}\n");
    const Document document(file.path());
    EXPECT_EQ(document.root().child("map").number("a", 0.0), 1.0);
    const Node map = document.root().child("map");
    EXPECT_EQ(map.number("b", 0.0), 2.0);
    map.finish();
    document.root().finish();
    EXPECT_EQ(texts(document), Lines{});
}

TEST(Node, MissingKeysAreReportedAtTheirMap) {
    const YamlFile file("first: 1\nmap:\n  inner: 1\n");
    const Document document(file.path());
    EXPECT_FALSE(document.root().child("map").required_child("sensor").present());
    EXPECT_EQ(texts(document), Lines{"2 map: key 'sensor' is missing"});
}

TEST(Node, EmptyValuesCountAsAbsent) {
    const YamlFile file("a:\nb: null\nc: ~\nlist: [1, ~]\n");
    const Document document(file.path());
    const Node root = document.root();
    EXPECT_EQ(root.number("a", 4.0), 4.0);
    EXPECT_FALSE(root.child("b").present());
    EXPECT_FALSE(root.has("c"));
    EXPECT_EQ(root.numbers("list"), std::vector<double>{});
    root.ignore("c");
    root.finish();
    EXPECT_EQ(texts(document), Lines{"4 list[1]: expected a number, found nothing"});
}

TEST(Node, ListWhereAMapIsExpectedIsSaidOnce) {
    const YamlFile file("map: [1, 2]\nother: 5\n");
    const Document document(file.path());
    const Node map = document.root().child("map");
    EXPECT_EQ(map.number("a", 1.0), 1.0);
    EXPECT_FALSE(map.required_child("b").present());
    map.finish();
    EXPECT_EQ(document.root().child("other").text("x", "y"), "y");
    EXPECT_EQ(texts(document),
              (Lines{"1 map: expected a map of keys, found a list", "2 other: expected a map of keys, found '5'"}));
}

TEST(Node, ItemsOfAListCarryIndexAndLine) {
    const YamlFile file("list:\n  - {id: a, size: 1}\n  - id: b\n    sise: 2\nsingle: {id: c}\n");
    const Document document(file.path());
    const auto items = document.root().child("list").items();
    ASSERT_EQ(items.size(), 2U);
    for (const auto& item : items) {
        EXPECT_NE(item.text("id", ""), "");
        EXPECT_GE(item.number("size", 0.0), 0.0);
        item.finish();
    }
    EXPECT_EQ(items[1].line(), 3);
    EXPECT_EQ(items[1].key_path(), "list[1]");
    EXPECT_EQ(document.root().child("single").items().size(), 1U);
    EXPECT_EQ(texts(document), Lines{"4 list[1]: unknown key 'sise'; did you mean 'size'?"});
}

TEST(Node, KindsAndKeys) {
    const YamlFile file("z: 1\na: [1]\nm: {k: 1}\n");
    const Document document(file.path());
    const Node root = document.root();
    EXPECT_TRUE(root.is_map());
    EXPECT_EQ(root.keys(), (std::vector<std::string>{"z", "a", "m"}));
    EXPECT_TRUE(root.child("z").is_scalar());
    EXPECT_TRUE(root.child("a").is_list());
    EXPECT_TRUE(root.child("m").is_map());
    EXPECT_EQ(root.child("m").child("k").key_path(), "m.k");
    EXPECT_EQ(root.child("m").line(), 3);
    EXPECT_TRUE(root.has("a"));
    EXPECT_FALSE(root.has("b"));
    EXPECT_FALSE(Node().present());
    EXPECT_EQ(Node().number("x", 3.0), 3.0);
}

}  // namespace pyroscene::config
