// tests/validation/figures.hpp: what the validation tests measured, as a table in the build folder.
//
// One file per test, <build>/validation/<name>.csv, with the columns test,case,mesh,quantity,reference,measured.  An empty reference
// means that there is none.  tools/plot_validation.py makes the plots and the tables of docs/validation.md from them.
#pragma once
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace toile::internal::test {

class Figures {
 public:
  explicit Figures(const std::string& name) : name_(name) {
    std::filesystem::create_directories(TOILE_VALIDATION_FOLDER);
    file_.open(std::string(TOILE_VALIDATION_FOLDER) + "/" + name + ".csv");
    file_ << "test,case,mesh,quantity,reference,measured\n";
  }
  static constexpr double no_reference = std::numeric_limits<double>::quiet_NaN();

  void add(const std::string& what, const std::string& mesh, const std::string& quantity, double reference,
           double measured) {
    char numbers[96];
    if (std::isnan(reference))
      std::snprintf(numbers, sizeof numbers, ",%.6g", measured);
    else
      std::snprintf(numbers, sizeof numbers, "%.6g,%.6g", reference, measured);
    file_ << name_ << ",\"" << what << "\",\"" << mesh << "\",\"" << quantity << "\"," << numbers << '\n';
    std::printf("%s %s, %s: %s %s\n", name_.c_str(), what.c_str(), mesh.c_str(), quantity.c_str(), numbers);
  }

 private:
  std::string name_;
  std::ofstream file_;
};

}  // namespace toile::internal::test
