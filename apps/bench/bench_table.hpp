// apps/bench/bench_table.hpp: the results of a benchmark, printed as table, CSV or JSON.
//
// A row carries its own columns; all rows of a table have the same ones in the same order.  A missing measurement is an
// empty cell: "-" in the table, nothing in CSV, null in JSON.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace toile::internal {

using BenchCell = std::variant<std::monostate, long, double, std::string>;

struct BenchField {
  std::string_view key, title;  // of CSV and JSON, with its unit; of the table
  BenchCell value;
  int digits = 0;  // after the point, in the table only
};

class BenchRow {
 public:
  void add(std::string_view key, std::string_view title, double value, int digits) {
    next(key, title).digits = digits;
    fields_.back().value = value;
  }
  void add(std::string_view key, std::string_view title, long value) { next(key, title).value = value; }
  void add(std::string_view key, std::string_view title, std::string value) {
    next(key, title).value = std::move(value);
  }
  void add_empty(std::string_view key, std::string_view title) { next(key, title); }
  // Empties fields that were not measured.
  template <class Keep>
  void empty_unless(Keep&& keep) {
    for (BenchField& field : fields_)
      if (!keep(field.key)) field.value = {};
  }
  const std::vector<BenchField>& fields() const { return fields_; }

 private:
  BenchField& next(std::string_view key, std::string_view title) {
    BenchField& field = fields_.emplace_back();
    field.key = key;
    field.title = title;
    return field;
  }
  std::vector<BenchField> fields_;
};

struct BenchTable {
  std::string_view name;  // the key of its rows in JSON; the first table's is "rows"
  std::vector<BenchRow> rows;
  bool on_its_side = false;  // the table is printed with a line per column
};

struct BenchResult {
  std::string_view bench;
  std::vector<BenchTable> tables;
  BenchRow facts;                  // one number each, about all rows
  std::vector<std::string> notes;  // for the table; sentences
  bool complete = true;            // false: a run could not begin, or ended early
};

std::string as_text(const BenchResult& result);
// The tables, each with a line of keys, an empty line between two.
std::string as_csv(const BenchResult& result);
// One object: bench, the facts, and each table's rows under its name.
std::string as_json(const BenchResult& result);

}  // namespace toile::internal
