#include "io/json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/file.hpp"
#include "io/json_line.hpp"

namespace toile::internal {
// Line and column of places in a text, asked for in increasing order.
class LineCounter {
 public:
  LineCounter(const char* begin, int first_line) : at_(begin), line_(first_line) {}

  void advance(const char* to) {
    for (; at_ < to; ++at_) {
      if (*at_ == '\n') {
        ++line_;
        column_ = 1;
      } else if ((static_cast<unsigned char>(*at_) & 0xc0) != 0x80) {  // not a continuation byte of UTF-8
        ++column_;
      }
    }
  }
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  const char* at_;
  int line_, column_ = 1;
};

namespace {

// How far the parser has read, shared by all copies of the iterator that it makes.
class ReadingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  ReadingIterator(const char* at, const char** read) : at_(at), read_(read) {}
  reference operator*() const { return *at_; }
  ReadingIterator& operator++() {
    *read_ = ++at_;
    return *this;
  }
  ReadingIterator operator++(int) {
    ReadingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const ReadingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const ReadingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** read_;
};

std::string place_in(std::string_view file, int line, int column) {
  std::string text = printable(file);
  if (line > 0) text += ':' + std::to_string(line) + ':' + std::to_string(column);
  return text;
}

std::string in_quotes(std::string_view name) { return '"' + printable(name) + '"'; }

// The parts of the parser's message: "; expected X" and "- unexpected Y" or "- invalid Z; last read: ...".
// "last read" is left out: it repeats everything since the last string or number.
struct SyntaxComplaint {
  std::string expected = "JSON";
  std::string got;
};
SyntaxComplaint syntax_complaint(std::string_view what) {
  SyntaxComplaint complaint;
  if (const auto at = what.find(" - "); at != std::string_view::npos) what = what.substr(at + 3);
  if (const auto at = what.rfind("; expected "); at != std::string_view::npos) {
    complaint.expected = what.substr(at + 11);
    what = what.substr(0, at);
  }
  if (const auto at = what.find("; last read: "); at != std::string_view::npos) what = what.substr(0, at);
  if (what.starts_with("unexpected ")) what = what.substr(11);
  complaint.got = what;
  return complaint;
}

}  // namespace

std::string pointer_step(std::string_view key) {
  std::string step = "/";
  for (const char c : key) {
    if (c == '~') {
      step += "~0";
    } else if (c == '/') {
      step += "~1";
    } else {
      step += c;
    }
  }
  return step;
}

// Receives the parser's events and puts the values into their containers.
//
// A token's place: between the end of the text read at the previous event and the token there are only white space,
// commas and colons, so its first character is the next other one.  The parser reads one character past a number; that
// this character may belong to what follows does no harm, as only a comma, a bracket or white space can follow.
class JsonBuilder {
 public:
  JsonBuilder(std::string_view text, std::string_view file, int first_line)
      : file_(std::make_shared<const std::string>(file)),
        begin_(text.data()),
        end_(begin_ + text.size()),
        read_(begin_),
        previous_(begin_),
        counter_(begin_, first_line) {}
  JsonBuilder(const JsonBuilder&) = delete;  // iterators point at it
  JsonBuilder& operator=(const JsonBuilder&) = delete;

  Json build() {
    nlohmann::json::sax_parse(ReadingIterator(begin_, &read_), ReadingIterator(end_, &read_), this);
    return std::move(root_);
  }

  bool null() { return add(std::monostate()); }
  bool boolean(bool value) { return add(value); }
  // Numbers are read again from the text: neither the locale nor the detour by an integer type (-0, 2^64) matters then.
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) { return number(value); }
  bool string(std::string& value) {
    check_length(value);
    return add(std::move(value));
  }
  bool binary(nlohmann::json::binary_t&) { return false; }  // not in text

  bool start_object(std::size_t) { return open(Json::Object()); }
  bool start_array(std::size_t) { return open(Json::Array()); }
  bool end_object() {
    check_duplicates(open_.back());
    return close();
  }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    begin_token();
    if (name.size() > Json::string_limit) {
      fail("keys of at most " + std::to_string(Json::string_limit) + " bytes", std::to_string(name.size()) + " bytes");
    }
    Container& container = open_.back();
    container.keys.push_back({counter_.line(), counter_.column()});
    container.key = std::move(name);
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) {
    SyntaxComplaint complaint = syntax_complaint(error.what());
    if (complaint.got == "end of input") {
      counter_.advance(end_);
      fail(complaint.expected, complaint.got);
    }
    // Otherwise the faulty token is a separator, just read, or the first thing behind the separators.
    const bool separator = complaint.got == "','" || complaint.got == "':'";
    const char* const last = std::max(read_ - 1, begin_);
    const char* const start = separator ? last : std::min(skip_separators(previous_), last);
    counter_.advance(start);
    if (error.id == 406) fail("a finite number", word_at(start));                  // beyond double: 1e999
    if (!complaint.got.ends_with('\'')) complaint.got += " at " + word_at(start);  // a bracket needs no "at"
    fail(complaint.expected, complaint.got);
  }

 private:
  struct KeyPlace {
    int line, column;
  };
  struct Container {
    Json value;
    std::string key;             // of the member to come
    std::vector<KeyPlace> keys;  // of all members so far
  };

  [[noreturn]] void fail(std::string_view expected, std::string_view got) const {
    throw InputError(place_in(*file_, counter_.line(), counter_.column()),
                     open_.empty() ? std::string() : printable(open_.back().value.pointer()), expected, got);
  }

  // A number or literal as it stands in the text; of a string the part that has been read.
  std::string word_at(const char* start) const {
    if (start != end_ && *start == '"') return printable({start, static_cast<std::size_t>(read_ - start)});
    const std::string_view rest(start, static_cast<std::size_t>(end_ - start));
    return printable(rest.substr(0, rest.find_first_of(" \t\r\n,:[]{}\"", 1)));
  }

  const char* skip_separators(const char* at) const {
    while (at != end_ && std::string_view(" \t\r\n,:").find(*at) != std::string_view::npos) ++at;
    return at;
  }

  void begin_token() {
    start_ = skip_separators(previous_);
    counter_.advance(start_);
    previous_ = read_;
  }

  bool number(double value) {
    begin_token();
    const auto [end, error] = std::from_chars(start_, end_, value);
    static_cast<void>(end);
    static_cast<void>(error);  // out of range here means too small: `value` keeps the parser's result
    return put(leaf(value));
  }

  void check_length(const std::string& text) {
    if (text.size() <= Json::string_limit) return;
    begin_token();
    fail("strings of at most " + std::to_string(Json::string_limit) + " bytes", std::to_string(text.size()) + " bytes");
  }

  template <class Value>
  bool add(Value value) {
    begin_token();
    return put(leaf(std::move(value)));
  }

  std::shared_ptr<const Json::Place> place(std::string step) const {
    return std::make_shared<const Json::Place>(
        Json::Place{file_, open_.empty() ? nullptr : open_.back().value.place_, std::move(step)});
  }

  // A value at the current token.  Elements of an array share its place, which is most of the values of a large file.
  template <class Value>
  Json leaf(Value value) {
    if (++values_ > Json::value_limit) fail("at most " + std::to_string(Json::value_limit) + " values", "more");
    Json json;
    json.value_ = std::move(value);
    json.line_ = counter_.line();
    json.column_ = counter_.column();
    if (!open_.empty() && open_.back().value.is_array()) {
      json.place_ = open_.back().value.place_;
      json.index_ = static_cast<int>(std::get<Json::Array>(open_.back().value.value_).size());
    } else {
      json.place_ = place(open_.empty() ? std::string() : open_.back().key);
    }
    return json;
  }

  template <class Value>
  bool open(Value value) {
    begin_token();
    if (open_.size() == Json::depth_limit) {
      fail("at most " + std::to_string(Json::depth_limit) + " arrays and objects inside each other", "one more");
    }
    Json json = leaf(std::move(value));
    if (json.index_ >= 0) {
      json.place_ = place(std::to_string(json.index_));
      json.index_ = -1;
    }
    open_.push_back({std::move(json), {}, {}});
    return true;
  }

  bool close() {
    previous_ = read_;
    Json json = std::move(open_.back().value);
    open_.pop_back();
    return put(std::move(json));
  }

  bool put(Json json) {
    if (open_.empty()) {
      root_ = std::move(json);
    } else if (open_.back().value.is_array()) {
      std::get<Json::Array>(open_.back().value.value_).push_back(std::move(json));
    } else {
      std::get<Json::Object>(open_.back().value.value_).emplace_back(std::move(open_.back().key), std::move(json));
    }
    return true;
  }

  // Sorted, not pairwise: an object may have a million keys.
  void check_duplicates(const Container& container) const {
    const Json::Object& members = std::get<Json::Object>(container.value.value_);
    std::vector<std::size_t> order(members.size());
    for (std::size_t m = 0; m < order.size(); ++m) order[m] = m;
    std::sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) {
      const int c = members[l].first.compare(members[r].first);
      return c < 0 || (c == 0 && l < r);
    });
    std::size_t repeat = members.size();
    std::size_t original = 0;
    for (std::size_t m = 1; m < order.size(); ++m) {
      if (members[order[m]].first == members[order[m - 1]].first && order[m] < repeat) {
        repeat = order[m];
        original = order[m - 1];
      }
    }
    if (repeat == members.size()) return;
    const std::string& name = members[repeat].first;
    throw InputError(place_in(*file_, container.keys[repeat].line, container.keys[repeat].column),
                     printable(container.value.pointer() + pointer_step(name)), "each key once",
                     in_quotes(name) + " again, first in line " + std::to_string(container.keys[original].line));
  }

  std::shared_ptr<const std::string> file_;
  const char* begin_;
  const char* end_;
  const char* read_;      // end of the text that the parser has read, exclusive
  const char* previous_;  // read_ at the previous event
  const char* start_ = nullptr;
  LineCounter counter_;
  std::vector<Container> open_;
  std::size_t values_ = 0;
  Json root_;
};

Json Json::parse(std::string_view text, std::string_view file) { return parse_json_line(text, file, 1); }

Json parse_json_line(std::string_view text, std::string_view file, int first_line) {
  if (text.size() > Json::text_limit) {
    throw InputError(printable(file), "", "at most " + std::to_string(Json::text_limit) + " bytes of JSON",
                     std::to_string(text.size()));
  }
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  // The parser takes a NUL byte for the end of the text and would ignore the rest.
  if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
    LineCounter counter(text.data(), first_line);
    counter.advance(text.data() + nul);
    throw InputError(place_in(file, counter.line(), counter.column()), "", "JSON", "a NUL byte");
  }
  if (text.empty()) text = "";  // a null pointer is not a valid iterator
  return JsonBuilder(text, file, first_line).build();
}

Json Json::load(const std::string& path) { return parse(read_file(path, text_limit), path); }

std::string Json::where() const { return place_ ? place_in(*place_->file, line_, column_) : std::string(); }

std::string Json::pointer() const {
  std::vector<const std::string*> steps;  // from here to the root, which has none
  for (const Place* place = place_.get(); place && place->around; place = place->around.get()) {
    steps.push_back(&place->step);
  }
  std::string text;
  for (std::size_t s = steps.size(); s-- > 0;) text += pointer_step(*steps[s]);
  if (index_ >= 0) text += '/' + std::to_string(index_);
  return text;
}

double Json::number() const {
  if (!is_number()) fail("a number", describe());
  return std::get<double>(value_);
}

long long Json::integer() const {
  constexpr double limit = 9007199254740991.0;  // 2^53 - 1: beyond, neighbouring integers are one double
  if (!is_number()) fail("an integer", describe());
  const double value = std::get<double>(value_);
  if (value != std::trunc(value) || std::abs(value) > limit) {
    fail(value != std::trunc(value) ? "an integer" : "an integer within +-(2^53 - 1)", describe());
  }
  return static_cast<long long>(value);
}

bool Json::boolean() const {
  if (!is_boolean()) fail("true or false", describe());
  return std::get<bool>(value_);
}

const std::string& Json::string() const {
  if (!is_string()) fail("a string", describe());
  return std::get<std::string>(value_);
}

const Json::Array& Json::array() const {
  if (!is_array()) fail("an array", describe());
  return std::get<Array>(value_);
}

const Json::Object& Json::object() const {
  if (!is_object()) fail("an object", describe());
  return std::get<Object>(value_);
}

const Json* Json::find(std::string_view key) const {
  for (const auto& [name, value] : object()) {
    if (name == key) return &value;
  }
  return nullptr;
}

const Json& Json::at(std::string_view key) const {
  const Json* value = find(key);
  if (!value) fail("the key " + in_quotes(key), "none (missing key)");
  return *value;
}

double Json::number_or(std::string_view key, double fallback) const {
  const Json* value = find(key);
  return value ? value->number() : fallback;
}

bool Json::boolean_or(std::string_view key, bool fallback) const {
  const Json* value = find(key);
  return value ? value->boolean() : fallback;
}

std::string Json::string_or(std::string_view key, std::string_view fallback) const {
  const Json* value = find(key);
  return value ? value->string() : std::string(fallback);
}

void Json::allow_only(std::span<const std::string_view> keys) const {
  for (const auto& [name, value] : object()) {
    if (std::find(keys.begin(), keys.end(), name) != keys.end()) continue;
    // A key of a megabyte is no misspelling, and its edit distance would take a while.
    const std::string_view nearest =
        name.size() <= 100 ? nearest_name(name, keys.data(), keys.size()) : std::string_view();
    value.fail(nearest.empty() ? "a known key" : "a known key (nearest: " + in_quotes(nearest) + ")", in_quotes(name));
  }
}

void Json::fail(std::string_view expected, std::string_view got) const {
  throw InputError(where(), printable(pointer()), expected, got);
}

std::string Json::describe() const {
  const auto count = [](std::string_view kind, std::size_t size) { return std::string(kind) + std::to_string(size); };
  switch (type()) {
    case Type::null:
      return "null";
    case Type::boolean:
      return std::get<bool>(value_) ? "true" : "false";
    case Type::number: {
      char text[32];
      const auto end = std::to_chars(text, text + sizeof text, std::get<double>(value_)).ptr;
      return {text, end};
    }
    case Type::string:
      return "the string " + in_quotes(std::get<std::string>(value_));
    case Type::array:
      return count("an array of ", std::get<Array>(value_).size());
    case Type::object:
      return count("an object of ", std::get<Object>(value_).size());
  }
  return {};
}

}  // namespace toile::internal
