// tests/generated/covering.hpp: rows of choices in which every two values of different axes that may meet do meet.
//
// Greedy: a row begins with a pair that is still open and takes, axis by axis, the value that closes most open pairs with what it has.
// The same axes give the same rows, everywhere.
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

namespace toile::internal::generated {

struct Axis {
  std::string_view name;
  std::vector<std::string_view> values;
};

// No row has one of `a` and one of `b` at once.
struct Exclusion {
  std::string_view axis_a;
  std::vector<std::string_view> a;
  std::string_view axis_b;
  std::vector<std::string_view> b;
};

// [axis] number of its value
using Choice = std::vector<std::size_t>;

class Space {
 public:
  // Throws std::logic_error for an exclusion of axes or values that are not there.
  Space(std::vector<Axis> axes, const std::vector<Exclusion>& exclusions);

  const std::vector<Axis>& axes() const { return axes_; }
  std::size_t axis(std::string_view name) const;
  std::size_t value(std::size_t axis, std::string_view name) const;
  std::string_view name_of(const Choice& choice, std::string_view axis) const;

  std::size_t value_count() const { return first_.back(); }
  // A value by its number among those of all axes.
  std::size_t number(std::size_t axis, std::size_t value) const { return first_[axis] + value; }
  bool may_meet(std::size_t number_a, std::size_t number_b) const {
    return allowed_[number_a * value_count() + number_b];
  }
  bool is_allowed(const Choice& choice) const;

  // The choice with values taken in the order of `wishes` ([axis] its values, most wanted first), `fixed` first.  Empty when none exists.
  Choice complete(const std::vector<std::pair<std::size_t, std::size_t>>& fixed,
                  const std::vector<std::vector<std::size_t>>& wishes) const;

 private:
  std::vector<Axis> axes_;
  std::vector<std::size_t> first_;  // [axis] number of its first value; at the end how many there are
  std::vector<char> allowed_;       // [number][number]
};

// One pair of values of two axes.
struct ValuePair {
  std::size_t a, b;  // their numbers, a < b
};
// All that some choice has.
std::vector<ValuePair> possible_pairs(const Space& space);
std::vector<Choice> covering_rows(const Space& space);
// Those of `possible` that no row has.
std::vector<ValuePair> missing_pairs(const Space& space, const std::vector<ValuePair>& possible,
                                     const std::vector<Choice>& rows);

}  // namespace toile::internal::generated
