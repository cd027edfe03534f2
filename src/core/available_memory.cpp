#include "core/available_memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace toile::internal {
namespace {

constexpr double mb = 1 << 20;

// The number after `key` in a file of lines "key number ...", in the file's unit; the first number when the key is empty.
std::optional<double> number_in_file(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string word; file >> word;) {
    if (!key.empty() && word != key) continue;
    if (!key.empty() && !(file >> word)) break;
    try {
      return std::stod(word);
    } catch (const std::exception&) {  // "max": no limit
      return std::nullopt;
    }
  }
  return std::nullopt;
}

// The group's limit less its use; memory that only caches files does not count as used.
double left_in_group_mb(const std::string& limit, const std::string& used, const std::string& statistics,
                        const std::string& caches) {
  const auto most = number_in_file(limit, ""), now = number_in_file(used, "");
  if (!most || !now) return std::numeric_limits<double>::infinity();
  return std::max(0.0, *most - *now + number_in_file(statistics, caches).value_or(0)) / mb;
}

double limit_mb(decltype(RLIMIT_AS) resource) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(limit.rlim_cur) / mb;
}

}  // namespace

double available_memory_mb() {
  double least =
      number_in_file("/proc/meminfo", "MemAvailable:").value_or(std::numeric_limits<double>::infinity()) / 1024;
  const std::string group = "/sys/fs/cgroup/";
  least = std::min(
      least, left_in_group_mb(group + "memory.max", group + "memory.current", group + "memory.stat", "inactive_file"));
  least =
      std::min(least, left_in_group_mb(group + "memory/memory.limit_in_bytes", group + "memory/memory.usage_in_bytes",
                                       group + "memory/memory.stat", "total_inactive_file"));
  return std::min({least, limit_mb(RLIMIT_AS), limit_mb(RLIMIT_DATA)});
}

}  // namespace toile::internal
