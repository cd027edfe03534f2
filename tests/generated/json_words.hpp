// tests/generated/json_words.hpp: JSON text from parts, members in the order in which they come.
#pragma once
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile::internal::generated {

inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

inline std::string word(std::string_view text) { return '"' + std::string(text) + '"'; }

inline std::string list(const std::vector<std::string>& values) {
  std::string text = "[";
  for (const std::string& value : values) text += (text.size() > 1 ? ", " : "") + value;
  return text + "]";
}

inline std::string vector(double x, double y, double z) { return list({number(x), number(y), number(z)}); }

class Object {
 public:
  Object& set(std::string_view key, std::string value) {
    members_.emplace_back(key, std::move(value));
    return *this;
  }
  // A default that is written out where nothing else stands.
  Object& set_if_absent(std::string_view key, std::string value) {
    return has(key) ? *this : set(key, std::move(value));
  }
  bool has(std::string_view key) const {
    for (const auto& member : members_)
      if (member.first == key) return true;
    return false;
  }
  bool empty() const { return members_.empty(); }
  std::string text() const {
    std::string text = "{";
    for (const auto& [key, value] : members_) text += (text.size() > 1 ? ", " : "") + word(key) + ": " + value;
    return text + "}";
  }

 private:
  std::vector<std::pair<std::string, std::string>> members_;
};

}  // namespace toile::internal::generated
