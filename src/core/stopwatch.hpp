// core/stopwatch.hpp: wall time for reports.  Never used for a decision.
#pragma once
#include <chrono>

namespace toile::internal {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Adds the time until its end of scope to `total_s`.
class Timed {
 public:
  explicit Timed(double& total_s) : total_s_(total_s) {}
  ~Timed() { total_s_ += watch_.seconds(); }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  Stopwatch watch_;
  double& total_s_;
};

}  // namespace toile::internal
