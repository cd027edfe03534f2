// io/obj_words.hpp: an OBJ file as words, line by line.
#pragma once
#include <string_view>

namespace toile::internal {

// Words of a line, with the number of the line on which each one stands.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ == text_.size(); }
  int line() const { return line_; }

  // The next word of this line, over "\" continuations; empty at the end of the line or at a comment.
  std::string_view next() {
    skip_blanks();
    if (at_end() || is_newline(text_[at_]) || text_[at_] == '#') return {};
    const std::size_t begin = at_;
    while (!at_end() && !is_blank(text_[at_]) && !is_newline(text_[at_]) && continuation() == 0) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  // The rest of this line, trimmed: a name.
  std::string_view rest() {
    while (!at_end() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (!at_end() && !is_newline(text_[at_])) ++at_;
    std::size_t end = at_;
    while (end > begin && is_blank(text_[end - 1])) --end;
    return text_.substr(begin, end - begin);
  }

  // Goes to the beginning of the next line.  A comment ends with its line: a path in it may well end in "\".
  void next_line() {
    while (!at_end() && !is_newline(text_[at_])) ++at_;
    at_ += newline(at_);
    if (!at_end()) ++line_;
  }
  // The same for a line whose words do not matter, but whose continuations belong to it.
  void skip_line() {
    while (!next().empty()) {
    }
    next_line();
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_newline(char c) { return c == '\n' || c == '\r'; }

  // Length of the line end at `position`: "\n", "\r\n", "\r"; 0 when there is none.
  std::size_t newline(std::size_t position) const {
    if (position >= text_.size() || !is_newline(text_[position])) return 0;
    return text_.substr(position, 2) == "\r\n" ? 2 : 1;
  }
  // Length of "\" and the line end behind it.
  std::size_t continuation() const {
    if (text_[at_] != '\\') return 0;
    const std::size_t length = newline(at_ + 1);
    return length == 0 ? 0 : 1 + length;
  }
  void skip_blanks() {
    while (!at_end()) {
      if (is_blank(text_[at_])) {
        ++at_;
      } else if (const std::size_t length = continuation()) {
        at_ += length;
        ++line_;
      } else {
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace toile::internal
