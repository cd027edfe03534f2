// io/json_text.hpp: writes JSON whose keys keep the order in which they are given, and whose numbers read back to the bit.
//
//   JsonText text;  text.begin_object();  text.member("frames", 75);  text.end_object();  text.str()
//
// A number that is not finite becomes null, and a byte that is not UTF-8 U+FFFD: JSON cannot express them.
#pragma once
#include "core/utf8.hpp"

#include <charconv>
#include <cmath>
#include <concepts>
#include <string>
#include <string_view>

namespace toile::internal {

class JsonText {
 public:
  // `indent` spaces per level; 0 writes one line.
  explicit JsonText(int indent = 2) : indent_(indent) {}

  void begin_object() { open('{'); }
  void end_object() { close('}'); }
  void begin_array() { open('['); }
  void end_array() { close(']'); }
  void key(std::string_view name) {
    next();
    quote(name);
    text_ += indent_ > 0 ? ": " : ":";
    after_key_ = true;
  }
  void value(std::string_view string) {
    next();
    quote(string);
  }
  void value(const char* string) { value(std::string_view(string)); }
  void value(bool b) {
    next();
    text_ += b ? "true" : "false";
  }
  void value(std::integral auto i) {
    next();
    text_ += std::to_string(i);
  }
  void value(double x) {
    if (!std::isfinite(x)) return null();
    next();
    char digits[32];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
  }
  void null() { raw("null"); }
  // Inserts text that is JSON already.
  void raw(std::string_view json) {
    next();
    text_ += json;
  }
  template <class T>
  void member(std::string_view name, const T& v) {
    key(name);
    value(v);
  }
  const std::string& str() const { return text_; }

 private:
  void next() {
    if (after_key_) {
      after_key_ = false;
      return;
    }
    if (!first_) text_ += ',';
    if (depth_ > 0) new_line();
    first_ = false;
  }
  void new_line() {
    if (indent_ == 0) return;
    text_ += '\n';
    text_.append(static_cast<std::size_t>(indent_) * static_cast<std::size_t>(depth_), ' ');
  }
  void open(char bracket) {
    next();
    text_ += bracket;
    ++depth_;
    first_ = true;
  }
  void close(char bracket) {
    --depth_;
    if (!first_) new_line();
    text_ += bracket;
    first_ = false;
  }
  void quote(std::string_view string) {
    static constexpr char hex[] = "0123456789abcdef";
    text_ += '"';
    while (!string.empty()) {
      const std::size_t bytes = utf8_character_bytes(string);
      const auto byte = static_cast<unsigned char>(string.front());
      if (bytes == 0) {
        text_ += "\xef\xbf\xbd";
      } else if (byte == '"' || byte == '\\') {
        text_ += '\\';
        text_ += string.front();
      } else if (byte < 0x20) {
        text_ += "\\u00";
        text_ += hex[byte >> 4];
        text_ += hex[byte & 15];
      } else {
        text_ += string.substr(0, bytes);
      }
      string.remove_prefix(bytes == 0 ? 1 : bytes);
    }
    text_ += '"';
  }

  std::string text_;
  int indent_, depth_ = 0;
  bool first_ = true, after_key_ = false;
};

}  // namespace toile::internal
