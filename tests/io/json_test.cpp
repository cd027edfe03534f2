#include "io/json.hpp"

#include "io/json_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/scratch.hpp"

namespace toile::internal {
namespace {

using namespace std::string_literals;

Json parse(std::string_view text) { return Json::parse(text, "s.json"); }

std::string complaint(std::string_view text) {
  return message_of<InputError>([&] { parse(text); });
}

template <class Get>
std::string complaint(std::string_view text, Get&& get) {
  const Json json = parse(text);
  return message_of<InputError>([&] { get(json); });
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(Json, ReadsEveryType) {
  const Json json = parse(R"({"a": null, "b": true, "c": -1.5e3, "d": "x\u00e4\n", "e": [1, 2], "f": {"g": false}})");
  EXPECT_TRUE(json.is_object());
  EXPECT_TRUE(json.at("a").is_null());
  EXPECT_TRUE(json.at("b").boolean());
  EXPECT_EQ(json.at("c").number(), -1500);
  EXPECT_EQ(json.at("d").string(), "x\xc3\xa4\n");
  EXPECT_EQ(json.at("e").array().size(), 2u);
  EXPECT_EQ(json.at("e").array()[1].integer(), 2);
  EXPECT_FALSE(json.at("f").at("g").boolean());
}

TEST(Json, ReadsABareValue) {
  EXPECT_EQ(parse(" 7 ").integer(), 7);
  EXPECT_EQ(parse("\"\"").string(), "");
  EXPECT_TRUE(parse("null").is_null());
  EXPECT_TRUE(parse("[]").array().empty());
  EXPECT_TRUE(parse("{}").object().empty());
}

TEST(Json, KeepsTheOrderOfKeys) {
  const Json json = parse(R"({"z": 1, "a": 2, "m": 3})");
  std::string keys;
  for (const auto& [key, value] : json.object()) keys += key;
  EXPECT_EQ(keys, "zam");
}

TEST(Json, KnowsWhereEachValueStands) {
  const Json json = parse(
      "{\n"                           // 1
      "  \"cloth\": [\n"              // 2
      "    {\"density\" : 0.2,\n"     // 3
      "     \"pins\": [1,[2 , 3],\n"  // 4
      "      4\n"                     // 5
      "     ], \"name\":\"x\"}]\n"    // 6
      "}\n");
  EXPECT_EQ(json.where(), "s.json:1:1");
  EXPECT_EQ(json.pointer(), "");
  const Json& cloth = json.at("cloth");
  EXPECT_EQ(cloth.where(), "s.json:2:12");
  EXPECT_EQ(cloth.pointer(), "/cloth");
  const Json& first = cloth.array()[0];
  EXPECT_EQ(first.where(), "s.json:3:5");
  EXPECT_EQ(first.pointer(), "/cloth/0");
  EXPECT_EQ(first.at("density").where(), "s.json:3:18");
  EXPECT_EQ(first.at("density").pointer(), "/cloth/0/density");
  const auto& pins = first.at("pins").array();
  EXPECT_EQ(pins[0].where(), "s.json:4:15");
  EXPECT_EQ(pins[0].pointer(), "/cloth/0/pins/0");
  EXPECT_EQ(pins[1].where(), "s.json:4:17");
  EXPECT_EQ(pins[1].pointer(), "/cloth/0/pins/1");
  EXPECT_EQ(pins[1].array()[0].where(), "s.json:4:18");
  EXPECT_EQ(pins[1].array()[1].where(), "s.json:4:22");
  EXPECT_EQ(pins[1].array()[1].pointer(), "/cloth/0/pins/1/1");
  EXPECT_EQ(pins[2].where(), "s.json:5:7");
  EXPECT_EQ(pins[2].pointer(), "/cloth/0/pins/2");
  EXPECT_EQ(first.at("name").where(), "s.json:6:16");
}

TEST(Json, TakesTheLineOfANumberFromItsFirstDigit) {
  // The parser reads one character past a number: here the line end.
  const Json json = parse("[1\n,2\n,\n3\n]");
  EXPECT_EQ(json.array()[0].where(), "s.json:1:2");
  EXPECT_EQ(json.array()[1].where(), "s.json:2:2");
  EXPECT_EQ(json.array()[2].where(), "s.json:4:1");
  EXPECT_EQ(parse("\n\n 17").where(), "s.json:3:2");
}

TEST(Json, CountsColumnsInCharactersAndLinesByLineFeed) {
  const Json json = parse("{\"\xc3\xa4\xe2\x82\xac\": 1,\r\n\"b\": 2}");
  EXPECT_EQ(json.object()[0].second.where(), "s.json:1:8");
  EXPECT_EQ(json.at("b").where(), "s.json:2:6");
}

TEST(Json, CountsLinesFromWhereTheTextBegins) {
  const Json json = parse_json_line("{\n\"a\": 1}", "jobs.jsonl", 41);
  EXPECT_EQ(json.where(), "jobs.jsonl:41:1");
  EXPECT_EQ(json.at("a").where(), "jobs.jsonl:42:6");
  for (const char* wrong : {"{\"a\" 1}", "[\0]"})
    EXPECT_TRUE(message_of<InputError>([&] {
                  parse_json_line(std::string_view(wrong, 3), "jobs.jsonl", 41);
                }).starts_with("jobs.jsonl:41:"));
}

TEST(Json, SkipsAByteOrderMark) { EXPECT_EQ(parse("\xef\xbb\xbf[1]").array()[0].where(), "s.json:1:2"); }

TEST(Json, EscapesKeysInPointers) {
  const Json json = parse(R"({"a/b": {"~": 1, "": {"x y": 2}}})");
  EXPECT_EQ(json.at("a/b").at("~").pointer(), "/a~1b/~0");
  EXPECT_EQ(json.at("a/b").at("").at("x y").pointer(), "/a~1b//x y");
}

TEST(Json, StillKnowsItsPlaceOutsideItsParent) {
  Json copy;
  EXPECT_EQ(copy.where(), "");
  {
    const Json json = parse("{\"a\": [0,\n [5]]}");
    copy = json.at("a").array()[1].array()[0];
  }
  EXPECT_EQ(copy.where(), "s.json:2:3");
  EXPECT_EQ(copy.pointer(), "/a/1/0");
  EXPECT_EQ(copy.number(), 5);
}

TEST(Json, ReadsNumbersToTheBit) {
  const Json json =
      parse("[0.1, 1e-3, 123456789012345678, -0, -0.0, 5e-324, 1.7976931348623157e308, 18446744073709551616]");
  const auto& a = json.array();
  EXPECT_EQ(a[0].number(), 0.1);
  EXPECT_EQ(a[1].number(), 0.001);
  EXPECT_EQ(a[2].number(), 123456789012345678.0);
  EXPECT_TRUE(a[3].number() == 0 && std::signbit(a[3].number()));
  EXPECT_TRUE(a[4].number() == 0 && std::signbit(a[4].number()));
  EXPECT_EQ(a[5].number(), 5e-324);
  EXPECT_EQ(a[6].number(), 1.7976931348623157e308);
  EXPECT_EQ(a[7].number(), 18446744073709551616.0);
  EXPECT_EQ(parse("1e-400").number(), 0);
}

TEST(Json, ReadsNumbersInTheLocaleOfADecimalComma) {
  const CommaLocale comma;
  const Json json = parse("[1234567.5, -0.25, 1.5e3, 2]");
  EXPECT_EQ(json.array()[0].number(), 1234567.5);
  EXPECT_EQ(json.array()[1].number(), -0.25);
  EXPECT_EQ(json.array()[2].number(), 1500);
  EXPECT_EQ(json.array()[0].describe(), "1234567.5");
  EXPECT_NE(complaint("[1,5.]"), "none");
}

TEST(Json, RefusesNumbersThatAreNotFinite) {
  EXPECT_EQ(complaint("{\"a\": [1,\n 1e999]}"), "s.json:2:2: /a: expected a finite number, got 1e999");
  EXPECT_EQ(complaint("-1e999"), "s.json:1:1: expected a finite number, got -1e999");
  for (const char* text : {"NaN", "[nan]", "[Infinity]", "[-Infinity]", "[inf]", "[1e]", "[0x10]", "[01]", "[+1]",
                           "[.5]", "[1.]", "[-]", "[1.5.2]", "[1 2]"}) {
    EXPECT_NE(complaint(text), "none") << text;
  }
}

TEST(Json, NamesThePlaceOfASyntaxError) {
  EXPECT_EQ(complaint("{\n \"a\" 12}"), "s.json:2:6: expected ':', got number literal at 12");
  EXPECT_EQ(complaint("{\"a\": [1,\n  ,2]}"), "s.json:2:3: /a: expected '[', '{', or a literal, got ','");
  EXPECT_EQ(complaint("[1,\n2\n"), "s.json:3:1: expected ']', got end of input");
  EXPECT_EQ(complaint("[1]\n\n]"), "s.json:3:1: expected end of input, got ']'");
  EXPECT_EQ(complaint("[1\n2]"), "s.json:2:1: expected ']', got number literal at 2");
  EXPECT_EQ(complaint("{\"a\":1]"), "s.json:1:7: expected '}', got ']'");
  EXPECT_EQ(complaint("[\n truw]"), "s.json:2:2: expected JSON, got invalid literal at truw");
  EXPECT_EQ(complaint("").substr(0, 12), "s.json:1:1: ");
  EXPECT_EQ(complaint("[\n\"abc").substr(0, 12), "s.json:2:1: ");
  EXPECT_EQ(complaint("[\n\"abc\n\"]").substr(0, 12), "s.json:2:1: ");
}

TEST(Json, RefusesWhatIsNotJson) {
  for (const std::string& text : {""s,
                                  " "s,
                                  "{"s,
                                  "}"s,
                                  "["s,
                                  "]"s,
                                  "[,]"s,
                                  "[1,]"s,
                                  "{\"a\"}"s,
                                  "{\"a\":}"s,
                                  "{\"a\":1,}"s,
                                  "{a:1}"s,
                                  "{'a':1}"s,
                                  "{1:1}"s,
                                  "// comment\n1"s,
                                  "/* comment */ 1"s,
                                  "\"\t\""s,
                                  "\"\\x\""s,
                                  "\"\\ud800\""s,
                                  "\"\\udc00\""s,
                                  "\"\\u12\""s,
                                  "tru"s,
                                  "True"s,
                                  "1 1"s,
                                  "[1]x"s,
                                  "\xff\xfe[1]"s,
                                  "[1\0]"s,
                                  "[1]\0"s,
                                  "\"a\0b\""s,
                                  "\0"s}) {
    EXPECT_NE(complaint(text), "none") << printable(text);
  }
}

TEST(Json, RefusesWhatStandsBehindANulByte) {
  EXPECT_EQ(complaint("{\"a\": 1}\n\0 garbage"s), "s.json:2:1: expected JSON, got a NUL byte");
}

TEST(Json, RefusesTextThatIsNotUtf8) {
  for (const char* bytes : {"\x80", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xff"}) {
    EXPECT_EQ(complaint("[\n\""s + bytes + "\"]").substr(0, 12), "s.json:2:1: ") << bytes;
    EXPECT_NE(complaint("{\""s + bytes + "\": 1}"), "none") << bytes;
    EXPECT_NE(complaint(std::string(bytes) + "1"), "none") << bytes;
  }
  EXPECT_EQ(parse("\"\xf0\x9f\x91\x95\"").string(), "\xf0\x9f\x91\x95");
}

TEST(Json, RefusesAKeyTwice) {
  EXPECT_EQ(complaint("{\"x\": {\"a\": 1,\n \"b\": 2, \"a\": 3}}"),
            "s.json:2:10: /x/a: expected each key once, got \"a\" again, first in line 1");
  EXPECT_EQ(complaint("{\"b\":0,\n\"a\":0,\n\"b\":0,\n\"a\":0}"),
            "s.json:3:1: /b: expected each key once, got \"b\" again, first in line 1");
  EXPECT_NE(complaint("{\"a\":0,\n\"b\":0,\n\"a\":0,\n\"b\":0}").find("s.json:3:1: /a: "), std::string::npos);
  EXPECT_NE(complaint("{\"a\": 1, \"\\u0061\": 2}"), "none");
  EXPECT_EQ(complaint("[{\"a\": 1}, {\"a\": 2}]"), "none");
}

TEST(Json, RefusesWhatIsTooDeep) {
  EXPECT_EQ(complaint(nested(64)), "none");
  const std::string message = complaint(nested(65));
  EXPECT_EQ(message.substr(0, 13), "s.json:1:65: ");
  EXPECT_NE(message.find("expected at most 64 arrays and objects inside each other"), std::string::npos) << message;
  EXPECT_NE(complaint(std::string(5'000'000, '[')), "none");
  std::string objects;
  for (int i = 0; i < 65; ++i) objects += "{\"a\":";
  EXPECT_NE(complaint(objects).find("at most 64"), std::string::npos);
}

TEST(Json, RefusesStringsAndKeysBeyondAMegabyte) {
  const std::string longest(Json::string_limit, 'x');
  EXPECT_EQ(parse('"' + longest + '"').string().size(), Json::string_limit);
  EXPECT_EQ(complaint("[\n \"x" + longest + "\"]"),
            "s.json:2:2: expected strings of at most 1048576 bytes, got 1048577 bytes");
  EXPECT_EQ(complaint("{\"" + longest + "\": 1}"), "none");
  EXPECT_EQ(complaint("{\n  \"x" + longest + "\": 1}"),
            "s.json:2:3: expected keys of at most 1048576 bytes, got 1048577 bytes");
}

TEST(Json, RefusesTextBeyondItsLimit) {
  std::string text(Json::text_limit, ' ');
  text[0] = '1';
  EXPECT_EQ(parse(text).number(), 1);
  text += ' ';
  EXPECT_EQ(complaint(text), "s.json: expected at most 67108864 bytes of JSON, got 67108865");
}

TEST(Json, RefusesMoreValuesThanItCanHold) {
  std::string text = "[0";
  while (text.size() < 2 * Json::value_limit - 2) text += ",0";  // with the array itself: as many as allowed
  EXPECT_EQ(parse(text + "]").array().size(), Json::value_limit - 1);
  EXPECT_NE(complaint(text + ",0]").find("expected at most 2000000 values, got more"), std::string::npos);
}

TEST(Json, DoesNotRepeatALongKeyInEveryValueBelowIt) {
  std::string text = "{\"" + std::string(Json::string_limit, 'x') + "\": {";
  for (int i = 0; i < 30'000; ++i) text += "\"k" + std::to_string(i) + "\":[0,{}],";
  const Json json = parse(text + "\"last\": 0}}");  // were it repeated, in some 100 GB
  EXPECT_EQ(json.object()[0].second.at("last").pointer().size(), Json::string_limit + 6);
}

TEST(Json, FindsADuplicateAmongManyKeys) {
  std::string text = "{";
  for (int i = 0; i < 200'000; ++i) text += "\"k" + std::to_string(i) + "\":0,";
  EXPECT_EQ(complaint(text + "\"last\":0}"), "none");
  EXPECT_NE(complaint(text + "\"k77777\":0}").find("/k77777: expected each key once"), std::string::npos);
}

TEST(Json, RefusesAFileCutAnywhere) {
  const std::string text = R"({"name": "shirt-walk", "cloth": [{"pattern": "p.json", "resolution_cm": 1.25,
    "panels": {"cuff": {"fabric": "knit", "on": true, "x": null}}, "pins": [[0, 1, 1, 0], [2, -1e2, 1.5, 0]]}]})";
  EXPECT_EQ(complaint(text), "none");
  for (std::size_t cut = 0; cut < text.size(); ++cut) {
    const std::string message = complaint(std::string_view(text).substr(0, cut));
    EXPECT_EQ(message.substr(0, 7), "s.json:") << cut;
    EXPECT_NE(message.find("expected "), std::string::npos) << message;
    EXPECT_NE(message.find(", got "), std::string::npos) << message;
  }
}

TEST(Json, SurvivesAnyFlippedByte) {
  const std::string text = R"({"a": [1, 2.5e3, true, null, "xA\u00e4"], "b": {"c": -0.0, "d": []}})";
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      std::string broken = text;
      broken[at] = static_cast<char>(byte);
      const std::string message = complaint(broken);  // either a value or an InputError with a place
      EXPECT_TRUE(message == "none" || message.substr(0, 7) == "s.json:") << message;
      for (const char c : message) ASSERT_GE(static_cast<unsigned char>(c), 0x20) << printable(broken);
    }
  }
}

TEST(JsonGetters, SayWhatTheyFound) {
  const char* text = "{\"a\":\n [1, \"x\", null, true, {}, 0.5]}";
  const auto element = [](std::size_t i) { return [i](const Json& json) { return json.at("a").array()[i]; }; };
  EXPECT_EQ(complaint(text, [&](const Json& j) { element(1)(j).number(); }),
            "s.json:2:6: /a/1: expected a number, got the string \"x\"");
  EXPECT_EQ(complaint(text, [&](const Json& j) { element(2)(j).string(); }),
            "s.json:2:11: /a/2: expected a string, got null");
  EXPECT_EQ(complaint(text, [&](const Json& j) { element(3)(j).array(); }),
            "s.json:2:17: /a/3: expected an array, got true");
  EXPECT_EQ(complaint(text, [&](const Json& j) { element(4)(j).boolean(); }),
            "s.json:2:23: /a/4: expected true or false, got an object of 0");
  EXPECT_EQ(complaint(text, [&](const Json& j) { element(5)(j).object(); }),
            "s.json:2:27: /a/5: expected an object, got 0.5");
  EXPECT_EQ(complaint(text, [&](const Json& j) { element(5)(j).integer(); }),
            "s.json:2:27: /a/5: expected an integer, got 0.5");
  EXPECT_EQ(complaint(text, [](const Json& j) { j.at("a").number(); }),
            "s.json:2:2: /a: expected a number, got an array of 6");
  EXPECT_EQ(complaint(text, [](const Json& j) { j.at("a").find("b"); }),
            "s.json:2:2: /a: expected an object, got an array of 6");
  EXPECT_EQ(complaint(text, [](const Json& j) { j.string(); }), "s.json:1:1: expected a string, got an object of 1");
  EXPECT_EQ(complaint(text, [](const Json& j) { j.at("mesh"); }),
            "s.json:1:1: expected the key \"mesh\", got none (missing key)");
  EXPECT_EQ(complaint(text, [](const Json& j) { j.at("a").array()[0].fail("a number > 1", "1"); }),
            "s.json:2:3: /a/0: expected a number > 1, got 1");
}

TEST(JsonGetters, TakeWholeNumbersThatNoRoundingHasTouched) {
  EXPECT_EQ(parse("9007199254740991").integer(), 9007199254740991);
  EXPECT_EQ(parse("-9007199254740991").integer(), -9007199254740991);
  EXPECT_EQ(parse("1e3").integer(), 1000);
  EXPECT_EQ(parse("-0").integer(), 0);
  const auto integer = [](const Json& json) { json.integer(); };
  EXPECT_NE(complaint("9007199254740993", integer), "none");  // would be ...992
  EXPECT_NE(complaint("1e300", integer), "none");
  EXPECT_NE(complaint("-1e300", integer), "none");
  EXPECT_NE(complaint("1.5", integer), "none");
}

TEST(JsonGetters, TakeTheFallbackForAnAbsentKeyOnly) {
  const Json json = parse(R"({"n": 2, "b": true, "s": "x", "null": null})");
  EXPECT_EQ(json.number_or("n", 7), 2);
  EXPECT_EQ(json.number_or("m", 7), 7);
  EXPECT_EQ(json.boolean_or("b", false), true);
  EXPECT_EQ(json.boolean_or("c", true), true);
  EXPECT_EQ(json.string_or("s", "y"), "x");
  EXPECT_EQ(json.string_or("t", "y"), "y");
  EXPECT_THROW(json.number_or("s", 7), InputError);
  EXPECT_THROW(json.number_or("null", 7), InputError);
  EXPECT_THROW(json.boolean_or("n", true), InputError);
  EXPECT_THROW(json.string_or("b", "y"), InputError);
}

TEST(JsonGetters, NameTheNearestOfTheKnownKeys) {
  const auto check = [](const Json& json) { json.at("body").allow_only({"mesh", "motion", "friction"}); };
  EXPECT_EQ(complaint("{\"body\": {\"mesh\": 1, \"motion\": 2}}", check), "none");
  EXPECT_EQ(complaint("{\"body\": {\"mesh\": 1,\n\"frictoin\": 2}}", check),
            "s.json:2:13: /body/frictoin: expected a known key (nearest: \"friction\"), got \"frictoin\"");
  EXPECT_EQ(complaint("{\"a\": 1}", [](const Json& json) { json.allow_only({}); }),
            "s.json:1:7: /a: expected a known key, got \"a\"");
}

TEST(JsonGetters, KeepControlCharactersOutOfMessages) {
  const std::string message =
      complaint(R"({"a\u001b[31m\n": "\u0007"})", [](const Json& json) { json.object()[0].second.number(); });
  EXPECT_EQ(message, "s.json:1:19: /a?[31m?: expected a number, got the string \"?\"");
}

TEST(JsonFile, IsReadWithItsPathInMessages) {
  const Scratch scratch;
  const std::string path = scratch.put("a.json", "{\n\"a\": 1}");
  EXPECT_EQ(Json::load(path).at("a").where(), path + ":2:6");
  EXPECT_EQ(
      message_of<InputError>([&] { Json::load(scratch.put("b.json", "[")); }).substr(0, (scratch / "b.json").size()),
      scratch / "b.json");
  EXPECT_EQ(message_of<IoError>([&] { Json::load(scratch / "c.json"); }),
            scratch / "c.json" + ": cannot open: No such file or directory");
}

}  // namespace
}  // namespace toile::internal
