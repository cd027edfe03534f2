#include "bench_table.hpp"

#include "io/json_text.hpp"

#include <fmt/printf.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace toile::internal {
namespace {

struct InTable {
  int digits;
  std::string operator()(std::monostate) const { return "-"; }
  std::string operator()(long i) const { return std::to_string(i); }
  std::string operator()(double x) const {
    if (!std::isfinite(x)) return "-";
    return fmt::sprintf("%.*f", digits, x);
  }
  std::string operator()(const std::string& text) const { return text; }
};

struct InCsv {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(long i) const { return std::to_string(i); }
  std::string operator()(double x) const {
    if (!std::isfinite(x)) return "";
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
  }
  std::string operator()(const std::string& text) const {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
    return quoted + '"';
  }
};

struct InJson {
  JsonText& json;
  void operator()(std::monostate) const { json.null(); }
  template <class T>
  void operator()(const T& value) const {
    json.value(value);
  }
};

void add_members(JsonText& json, const BenchRow& row) {
  for (const BenchField& field : row.fields()) {
    json.key(field.key);
    std::visit(InJson{json}, field.value);
  }
}

using Lines = std::vector<std::vector<std::string>>;

Lines on_its_side(const Lines& lines) {
  Lines turned(lines.front().size(), std::vector<std::string>(lines.size()));
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = 0; j < lines[i].size(); ++j) turned[j][i] = lines[i][j];
  return turned;
}

// First column to the left, the others to the right.
std::string aligned(const Lines& lines) {
  std::vector<std::size_t> width(lines.front().size(), 0);
  for (const auto& line : lines)
    for (std::size_t j = 0; j < line.size(); ++j) width[j] = std::max(width[j], line[j].size());
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t j = 0; j < line.size(); ++j) {
      const std::string space(width[j] - line[j].size(), ' ');
      text += j == 0 ? line[j] + space : space + line[j];
      if (j + 1 < line.size()) text += "  ";
    }
    while (text.ends_with(' ')) text.pop_back();
    text += '\n';
  }
  return text;
}

std::string as_text(const BenchTable& table) {
  Lines lines(1);
  for (const BenchField& field : table.rows.front().fields()) lines.front().emplace_back(field.title);
  for (const BenchRow& row : table.rows) {
    lines.emplace_back();
    for (const BenchField& field : row.fields()) lines.back().push_back(std::visit(InTable{field.digits}, field.value));
  }
  return aligned(table.on_its_side ? on_its_side(lines) : lines);
}

}  // namespace

std::string as_text(const BenchResult& result) {
  std::string text;
  for (const BenchTable& table : result.tables) {
    if (table.rows.empty()) continue;
    if (!text.empty()) text += '\n';
    text += as_text(table);
  }
  Lines facts;
  for (const BenchField& field : result.facts.fields())
    facts.push_back({std::string(field.title), std::visit(InTable{field.digits}, field.value)});
  if (!facts.empty()) {
    text += '\n';
    for (const auto& fact : facts) text += fact[0] + ": " + fact[1] + '\n';
  }
  for (const std::string& note : result.notes) text += note + '\n';
  return text;
}

std::string as_csv(const BenchResult& result) {
  std::string text;
  for (const BenchTable& table : result.tables) {
    if (table.rows.empty()) continue;
    if (!text.empty()) text += '\n';
    const auto add_line = [&](const BenchRow& row, const auto& word) {
      std::string line;
      for (const BenchField& field : row.fields())
        line.append(&field == row.fields().data() ? "" : ",").append(word(field));
      text += line + '\n';
    };
    add_line(table.rows.front(), [](const BenchField& field) { return std::string(field.key); });
    for (const BenchRow& row : table.rows)
      add_line(row, [](const BenchField& field) { return std::visit(InCsv{}, field.value); });
  }
  return text;
}

std::string as_json(const BenchResult& result) {
  JsonText json;
  json.begin_object();
  json.member("bench", result.bench);
  json.member("complete", result.complete);
  add_members(json, result.facts);
  json.key("notes");
  json.begin_array();
  for (const std::string& note : result.notes) json.value(note);
  json.end_array();
  for (const BenchTable& table : result.tables) {
    json.key(table.name);
    json.begin_array();
    for (const BenchRow& row : table.rows) {
      json.begin_object();
      add_members(json, row);
      json.end_object();
    }
    json.end_array();
  }
  json.end_object();
  return json.str() + '\n';
}

}  // namespace toile::internal
