#include "core/json.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "core/paths.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(JsonFile, BadFilesSayWhy) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::filesystem::path& file,
                           std::initializer_list<std::string_view> parts) {
        return fails_with([&] { read_json_file(file); }, parts);
    };
    EXPECT_TRUE(fails(folder / "no.json", {"no.json", "no such file"}));
    EXPECT_TRUE(fails(folder.path(), {"a folder", "a file"}));
    EXPECT_TRUE(fails(folder.write("a.json", ""), {"a.json", "an empty file", "a JSON object"}));
    EXPECT_TRUE(fails(folder.write("a.json", " \n\t "), {"an empty file"}));
    EXPECT_TRUE(fails(folder.write("a.json", "[1]"), {"array", "a JSON object"}));
    EXPECT_TRUE(fails(folder.write("a.json", "{\"a\": 1,\n \"b\": }"),
                      {"line 2, column", "text that is not JSON"}));
    EXPECT_TRUE(fails(folder.write("a.json", "{\"a\": [1, 2"), {"not JSON", "complete"}));
    EXPECT_TRUE(fails(folder.write("a.json", "{\"a\": NaN}"), {"line 1, column 7"}));
    EXPECT_TRUE(fails(folder.write("a.json", "{\"a\":\n 1e999}"),
                      {"line 2, column 2", "the number 1e999", "a double can hold"}));
    // Many small values take a hundred times the memory of their text.
    std::string many = "{\"a\":[";
    for (int k = 0; k < 4'000'000; ++k) many += "0,";
    EXPECT_TRUE(fails(folder.write("many.json", many + "0]}"), {"values", "at most 4000000"}));
    EXPECT_TRUE(fails(folder.write("a.json", "{\"a\": \"\xff\xfe\"}"), {"not JSON"}));
    EXPECT_TRUE(fails(folder.write("a.json", "\x89PNG\r\n"), {"not JSON"}));
    folder.write("a.json", "{\"a\": \"" + std::string(500, 'x') + "\"}");
    EXPECT_TRUE(
        fails_with([&] { read_json_file(folder / "a.json", 100); }, {"more than 100 bytes"}));
    // Deep nesting must not reach what recurses.
    const std::string open(200'000, '['), close(200'000, ']');
    EXPECT_TRUE(fails(folder.write("deep.json", "{\"a\":" + open + close + "}"),
                      {"deep.json", "200001 brackets", "at most 200"}));
    const std::string in_text = R"({"a": "\"[[[[{{{{"})";
    EXPECT_NO_THROW(read_json_file(folder.write("text.json", in_text)));
}

TEST(JsonFile, RoundTrips) {
    const TemporaryFolder folder;
    Json json;
    json["tiny"] = 4.9406564584124654e-324;
    json["third"] = 1.0 / 3.0;
    json["text"] = "gr\xc3\xbcn \"quoted\"";
    write_json_file(folder / "a.json", json);
    EXPECT_EQ(read_json_file(folder / "a.json"), json);
}

/// What a JsonReader says about one text.
::testing::AssertionResult refuses(const std::string& text,
                                   const std::function<void(const JsonReader&)>& read,
                                   std::initializer_list<std::string_view> parts) {
    const Json json = Json::parse(text);
    return fails_with([&] { read(JsonReader("f.json", json)); }, parts);
}

TEST(JsonReader, ReadsEveryKind) {
    const Json json = Json::parse(
        R"({"n": 2.5, "i": -3, "b": true, "t": "x", "v": [1, 2, 3], "m": [1,2,3,4,5,6,7,8,9]})");
    const JsonReader root("f.json", json);
    EXPECT_EQ(root["n"].number(), 2.5);
    EXPECT_EQ(root["n"].number_between(2.5, 3), 2.5);
    EXPECT_EQ(root["i"].integer(-3, 5), -3);
    EXPECT_TRUE(root["b"].boolean());
    EXPECT_EQ(root["t"].text(), "x");
    EXPECT_EQ(root["v"].vec3(), glm::dvec3(1, 2, 3));
    EXPECT_EQ(root["v"].at(1).number(), 2.0);
    EXPECT_EQ(root["v"].size(), 3u);
    // Row by row: the second number stands in the first row, second column.
    EXPECT_EQ(root["m"].matrix3()[1][0], 2.0);
    EXPECT_EQ(json_from(root["m"].matrix3()), json["m"]);
    EXPECT_EQ(json_from(glm::dvec3(1, 2, 3)), Json({1.0, 2.0, 3.0}));
    EXPECT_TRUE(root.has("n"));
    EXPECT_FALSE(root.has("x"));
    EXPECT_FALSE(root["n"].has("x"));
    EXPECT_EQ(root.keys(), (std::vector<std::string>{"n", "i", "b", "t", "v", "m"}));
    EXPECT_EQ(root["v"].at(2).field(), "v[2]");
}

TEST(JsonReader, EveryAccessorNamesTheField) {
    const auto a = [](auto read) { return [read](const JsonReader& root) { read(root["a"]); }; };
    const auto number = a([](const JsonReader& r) { r.number(); });
    EXPECT_TRUE(refuses("{}", number, {"f.json: a: found nothing, expected this field"}));
    EXPECT_TRUE(refuses(R"({"a": "1"})", number, {"f.json: a: found \"1\", expected a number"}));
    EXPECT_TRUE(refuses(R"({"a": null})", number, {"found null, expected a number"}));
    EXPECT_TRUE(refuses(R"({"a": 3})",
                        a([](const JsonReader& r) { r.number_between(0, 1); }),
                        {"a: found 3, expected a number between 0 and 1"}));
    const auto integer = a([](const JsonReader& r) { r.integer(1, 4); });
    EXPECT_TRUE(refuses(R"({"a": 1.5})", integer, {"found 1.5", "a whole number between 1 and 4"}));
    EXPECT_TRUE(refuses(R"({"a": 5})", integer, {"found 5"}));
    EXPECT_TRUE(refuses(R"({"a": 1e300})", integer, {"a whole number"}));
    EXPECT_TRUE(
        refuses(R"({"a": 1})", a([](const JsonReader& r) { r.boolean(); }), {"true or false"}));
    EXPECT_TRUE(refuses(R"({"a": [1]})", a([](const JsonReader& r) { r.text(); }), {"a text"}));
    const auto vec3 = a([](const JsonReader& r) { r.vec3(); });
    EXPECT_TRUE(refuses(R"({"a": [1, 2]})", vec3, {"a: found 2 elements, expected 3 numbers"}));
    EXPECT_TRUE(refuses(R"({"a": 7})", vec3, {"found 7, expected 3 numbers"}));
    EXPECT_TRUE(refuses(R"({"a": [1, "x", 3]})", vec3, {"a[1]: found \"x\"", "a number"}));
    EXPECT_TRUE(refuses(
        R"({"a": [1]})", a([](const JsonReader& r) { r.matrix3(); }), {"1 elements", "9 numbers"}));
    EXPECT_TRUE(refuses(R"({"a": [1]})",
                        a([](const JsonReader& r) { r.at(1); }),
                        {"a: found 1 elements, expected at least 2"}));
    EXPECT_TRUE(refuses(R"({"a": 1})", a([](const JsonReader& r) { r.size(); }), {"an array"}));
    EXPECT_TRUE(refuses(R"({"a": 1})", a([](const JsonReader& r) { r.keys(); }), {"an object"}));
    EXPECT_TRUE(refuses(R"({"a": 1})", a([](const JsonReader& r) { r["b"]; }), {"an object"}));
    EXPECT_TRUE(refuses(R"({"l": [{}, {"d": [0, {}]}]})",
                        [](const JsonReader& r) { r["l"].at(1)["d"].at(1).number(); },
                        {"f.json: l[1].d[1]: found {}"}));
}

TEST(JsonReader, RefusesUnknownFieldsAndNewerVersions) {
    const auto only = [](const JsonReader& r) { r.allow_only({"name", "size"}); };
    EXPECT_NO_THROW(only(JsonReader("f.json", Json::parse(R"({"size": 1})"))));
    EXPECT_TRUE(refuses(
        R"({"nmae": 1})", only, {"the unknown field \"nmae\"", "expected only name, size"}));

    const auto version = [](const JsonReader& r) { r.require_format_version(2); };
    EXPECT_NO_THROW(version(JsonReader("f.json", Json::parse(R"({"format_version": 2})"))));
    EXPECT_TRUE(refuses("{}", version, {"format_version", "nothing"}));
    EXPECT_TRUE(refuses(
        R"({"format_version": 3})", version, {"3 (written by a newer Livery)", "at most 2"}));
    EXPECT_TRUE(refuses(R"({"format_version": 0})", version, {"between 1 and 2"}));
    EXPECT_TRUE(refuses(R"({"format_version": "1"})", version, {"a number"}));
}

TEST(JsonReader, LongValuesAreCutInMessages) {
    const auto text = "{\"a\": \"" + std::string(1000, 'x') + "\"}";
    EXPECT_TRUE(refuses(text, [](const JsonReader& r) { r["a"].number(); }, {"xxx..., expected"}));
}

}  // namespace
}  // namespace livery
