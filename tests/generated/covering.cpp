#include "generated/covering.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace toile::internal::generated {
namespace {

constexpr std::size_t unset = static_cast<std::size_t>(-1);

std::vector<std::vector<std::size_t>> in_order(const Space& space) {
  std::vector<std::vector<std::size_t>> wishes;
  for (const Axis& axis : space.axes()) {
    wishes.emplace_back(axis.values.size());
    std::iota(wishes.back().begin(), wishes.back().end(), std::size_t{0});
  }
  return wishes;
}

}  // namespace

Space::Space(std::vector<Axis> axes, const std::vector<Exclusion>& exclusions) : axes_(std::move(axes)) {
  first_.assign(1, 0);
  for (const Axis& one : axes_) first_.push_back(first_.back() + one.values.size());
  allowed_.assign(value_count() * value_count(), 1);
  const auto forbid = [&](std::size_t a, std::size_t b) {
    allowed_[a * value_count() + b] = allowed_[b * value_count() + a] = 0;
  };
  for (std::size_t k = 0; k < axes_.size(); ++k)
    for (std::size_t a = first_[k]; a < first_[k + 1]; ++a)
      for (std::size_t b = first_[k]; b < first_[k + 1]; ++b)
        if (a != b) forbid(a, b);
  for (const Exclusion& one : exclusions) {
    const std::size_t axis_a = axis(one.axis_a), axis_b = axis(one.axis_b);
    for (const std::string_view a : one.a)
      for (const std::string_view b : one.b) forbid(number(axis_a, value(axis_a, a)), number(axis_b, value(axis_b, b)));
  }
}

std::size_t Space::axis(std::string_view name) const {
  for (std::size_t k = 0; k < axes_.size(); ++k)
    if (axes_[k].name == name) return k;
  throw std::logic_error("no axis " + std::string(name));
}

std::size_t Space::value(std::size_t axis, std::string_view name) const {
  const std::vector<std::string_view>& values = axes_[axis].values;
  const auto place = std::find(values.begin(), values.end(), name);
  if (place == values.end())
    throw std::logic_error("no value " + std::string(name) + " of " + std::string(axes_[axis].name));
  return static_cast<std::size_t>(place - values.begin());
}

std::string_view Space::name_of(const Choice& choice, std::string_view name) const {
  const std::size_t k = axis(name);
  return axes_[k].values[choice[k]];
}

bool Space::is_allowed(const Choice& choice) const {
  for (std::size_t k = 0; k < choice.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (!may_meet(number(j, choice[j]), number(k, choice[k]))) return false;
  return true;
}

Choice Space::complete(const std::vector<std::pair<std::size_t, std::size_t>>& fixed,
                       const std::vector<std::vector<std::size_t>>& wishes) const {
  Choice choice(axes_.size(), unset);
  const auto fits = [&](std::size_t k, std::size_t v) {
    for (std::size_t j = 0; j < axes_.size(); ++j)
      if (choice[j] != unset && !may_meet(number(j, choice[j]), number(k, v))) return false;
    return true;
  };
  for (const auto& [k, v] : fixed) {
    if (!fits(k, v)) return {};
    choice[k] = v;
  }
  // Depth first; exclusions are few, so it hardly ever turns back.
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < axes_.size(); ++k)
    if (choice[k] == unset) open.push_back(k);
  std::vector<std::size_t> tried(open.size(), 0);
  for (std::size_t depth = 0; depth < open.size();) {
    const std::size_t k = open[depth];
    choice[k] = unset;
    while (tried[depth] < wishes[k].size() && !fits(k, wishes[k][tried[depth]])) ++tried[depth];
    if (tried[depth] < wishes[k].size()) {
      choice[k] = wishes[k][tried[depth]++];
      if (++depth < open.size()) tried[depth] = 0;
    } else if (depth-- == 0) {
      return {};
    }
  }
  return choice;
}

std::vector<ValuePair> possible_pairs(const Space& space) {
  std::vector<ValuePair> pairs;
  const auto wishes = in_order(space);
  for (std::size_t j = 0; j < space.axes().size(); ++j)
    for (std::size_t k = j + 1; k < space.axes().size(); ++k)
      for (std::size_t a = 0; a < wishes[j].size(); ++a)
        for (std::size_t b = 0; b < wishes[k].size(); ++b)
          if (!space.complete({{j, a}, {k, b}}, wishes).empty())
            pairs.push_back({space.number(j, a), space.number(k, b)});
  return pairs;
}

std::vector<Choice> covering_rows(const Space& space) {
  const std::size_t count = space.value_count(), axes = space.axes().size();
  std::vector<char> open(count * count, 0);
  std::size_t left = 0;
  for (const auto& [a, b] : possible_pairs(space)) {
    open[a * count + b] = open[b * count + a] = 1;
    ++left;
  }
  std::vector<std::size_t> axis_of(count);
  for (std::size_t k = 0; k < axes; ++k)
    for (std::size_t v = 0; v < space.axes()[k].values.size(); ++v) axis_of[space.number(k, v)] = k;

  std::vector<Choice> rows;
  while (left > 0) {
    // The pair of the two values that have most pairs open.
    std::vector<std::size_t> open_of(count, 0);
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = 0; b < count; ++b) open_of[a] += open[a * count + b] != 0 ? 1 : 0;
    std::size_t best_a = 0, best_b = 0, most = 0;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b)
        if (open[a * count + b] != 0 && open_of[a] + open_of[b] > most) {
          most = open_of[a] + open_of[b];
          best_a = a;
          best_b = b;
        }
    const auto as_fixed = [&](std::size_t number) {
      return std::pair(axis_of[number], number - space.number(axis_of[number], 0));
    };
    std::vector<std::pair<std::size_t, std::size_t>> fixed = {as_fixed(best_a), as_fixed(best_b)};
    auto wishes = in_order(space);
    Choice row;
    while (fixed.size() < axes) {
      // The value that closes most; then the one with most pairs open, so that rare ones come early.
      std::size_t best = 0, best_closes = 0, best_open = 0;
      bool found = false;
      for (std::size_t n = 0; n < count; ++n) {
        if (std::any_of(fixed.begin(), fixed.end(), [&](const auto& f) { return f.first == axis_of[n]; })) continue;
        std::size_t closes = 0;
        for (const auto& [k, v] : fixed) closes += open[n * count + space.number(k, v)] != 0 ? 1 : 0;
        if (found && std::pair(closes, open_of[n]) <= std::pair(best_closes, best_open)) continue;
        fixed.push_back(as_fixed(n));
        if (!space.complete(fixed, wishes).empty()) {
          best = n;
          best_closes = closes;
          best_open = open_of[n];
          found = true;
        }
        fixed.pop_back();
      }
      fixed.push_back(as_fixed(best));
    }
    row = space.complete(fixed, wishes);
    for (std::size_t j = 0; j < axes; ++j)
      for (std::size_t k = j + 1; k < axes; ++k) {
        const std::size_t a = space.number(j, row[j]), b = space.number(k, row[k]);
        if (open[a * count + b] == 0) continue;
        open[a * count + b] = open[b * count + a] = 0;
        --left;
      }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<ValuePair> missing_pairs(const Space& space, const std::vector<ValuePair>& possible,
                                     const std::vector<Choice>& rows) {
  const std::size_t count = space.value_count();
  std::vector<char> seen(count * count, 0);
  for (const Choice& row : rows)
    for (std::size_t j = 0; j < row.size(); ++j)
      for (std::size_t k = j + 1; k < row.size(); ++k)
        seen[space.number(j, row[j]) * count + space.number(k, row[k])] = 1;
  std::vector<ValuePair> missing;
  for (const ValuePair& pair : possible)
    if (seen[pair.a * count + pair.b] == 0) missing.push_back(pair);
  return missing;
}

}  // namespace toile::internal::generated
