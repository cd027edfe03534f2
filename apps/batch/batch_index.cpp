// apps/batch/batch_index.cpp: the index of a batch: tables `jobs` and `reasons` of a SQLite database.
//
// It is made in memory and given out as bytes: no journal, and nobody reads a half of it.
#include "batch_files.hpp"
#include "core/error.hpp"

#include <sqlite3.h>

#include <memory>

namespace toile::internal {
namespace {

[[noreturn]] void fail(sqlite3* database, const char* what) {
  throw Error(ErrorKind::internal, std::string("index.sqlite: ") + what + ": " + sqlite3_errmsg(database));
}

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  void operator()(unsigned char* bytes) const { sqlite3_free(bytes); }
};
using Database = std::unique_ptr<sqlite3, Close>;

void execute(const Database& database, const std::string& sql) {
  if (sqlite3_exec(database.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail(database.get(), sql.c_str());
}

// An INSERT that is filled in row by row.
class Insert {
 public:
  Insert(const Database& database, const std::string& table, int columns) : database_(database.get()) {
    std::string sql = "INSERT INTO " + table + " VALUES (?";
    for (int k = 1; k < columns; ++k) sql += ", ?";
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_, (sql + ")").c_str(), -1, &statement, nullptr) != SQLITE_OK)
      fail(database_, "INSERT");
    statement_.reset(statement);
  }
  Insert& text(const std::string& text) {
    sqlite3_bind_text(statement_.get(), ++column_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Insert& number(double number) {
    sqlite3_bind_double(statement_.get(), ++column_, number);
    return *this;
  }
  Insert& null() {
    sqlite3_bind_null(statement_.get(), ++column_);
    return *this;
  }
  void row() {
    if (sqlite3_step(statement_.get()) != SQLITE_DONE) fail(database_, "a row");
    sqlite3_reset(statement_.get());
    column_ = 0;
  }

 private:
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Close> statement_;
  int column_ = 0;
};

constexpr int fixed_columns = 6;  // of `jobs`, before the figures

// A NUMERIC column keeps whole numbers as integers.
void create_tables(const Database& database, std::span<const JobVerdict> verdicts) {
  std::string figures;
  if (!verdicts.empty())
    for (const JobFigure& figure : verdicts.front().figures)
      figures += ", " + std::string(figure.name) + (figure.is_number ? " NUMERIC" : " TEXT");
  execute(database,
          "CREATE TABLE jobs (id TEXT PRIMARY KEY, line INTEGER, verdict TEXT, reason TEXT, key TEXT, folder TEXT" +
              figures + ")");
  execute(database, "CREATE TABLE reasons (id TEXT REFERENCES jobs (id), code TEXT, detail TEXT, reservation INTEGER)");
}

void add_reasons(Insert& insert, const std::string& id, const std::vector<Reason>& reasons, bool reservation) {
  for (const Reason& reason : reasons) {
    insert.text(id).text(reason.code).text(reason.detail).number(reservation ? 1 : 0);
    insert.row();
  }
}

}  // namespace

bool can_index() { return true; }

std::string index_of(std::span<const JobVerdict> verdicts) {
  sqlite3* opened = nullptr;
  const int failed = sqlite3_open(":memory:", &opened);
  const Database database(opened);
  if (failed != SQLITE_OK) fail(opened, "cannot be made");
  create_tables(database, verdicts);
  execute(database, "BEGIN");
  const int columns = fixed_columns + (verdicts.empty() ? 0 : static_cast<int>(verdicts.front().figures.size()));
  {
    Insert jobs(database, "jobs", columns), reasons(database, "reasons", 4);
    for (const JobVerdict& verdict : verdicts) {
      jobs.text(verdict.id).number(verdict.line).text(verdict.verdict);
      verdict.reasons.empty() ? jobs.null() : jobs.text(verdict.reasons.front().code);
      jobs.text(verdict.key).text("runs/" + verdict.id);
      for (const JobFigure& figure : verdict.figures) {
        if (const auto* number = std::get_if<double>(&figure.value)) {
          jobs.number(*number);
        } else if (const auto* text = std::get_if<std::string>(&figure.value)) {
          jobs.text(*text);
        } else {
          jobs.null();
        }
      }
      jobs.row();
      add_reasons(reasons, verdict.id, verdict.reasons, false);
      add_reasons(reasons, verdict.id, verdict.qualifications, true);
    }
  }
  execute(database, "CREATE INDEX reasons_of_jobs ON reasons (id)");
  execute(database, "COMMIT");
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, Close> bytes(sqlite3_serialize(database.get(), "main", &size, 0));
  if (!bytes) fail(database.get(), "cannot be given out");
  return {bytes.get(), bytes.get() + size};
}

}  // namespace toile::internal
