// sim/scene_hash.cpp: every setting of a scene that changes the result, in the order of its description (sim/settings.hpp).
//
// A setting is hashed as its key, its presence if it is optional, its count if it is a list, and its value.  So no two scenes have the
// same bytes.  A file only counts as present; its contents are in the hash of the object made of it.
#include "core/hash.hpp"
#include "sim/settings_scene.hpp"
#include "sim/setup.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace toile::internal {
namespace {

class SettingsHash {
 public:
  explicit SettingsHash(Hash& hash) : hash_(&hash) {}

  template <class Member>
  void number(const Setting& s, const Range&, const Member& x) {
    if (key(s)) add(x);
  }
  void number(const Setting& s, const Range&, double x, bool given) {
    if (!key(s)) return;
    add(given);
    add(x);
  }
  template <class Member>
  void whole(const Setting& s, const Range&, const Member& x) {
    if (key(s)) add(x);
  }
  void wholes(const Setting& s, const Range&, const std::vector<int>& x) {
    if (!key(s)) return;
    add(x.size());
    for (const int one : x) add(one);
  }
  template <class Member>
  void flag(const Setting& s, const Member& x) {
    if (key(s)) add(x);
  }
  void text(const Setting& s, const std::string& x) {
    if (key(s)) hash_->add_text(x);
  }
  void text_among(const Setting& s, std::span<const std::string_view>, const std::string& x) { text(s, x); }
  void path(const Setting& s, const std::string& x) {
    if (key(s)) add(!x.empty());
  }
  template <class E>
  void name(const Setting& s, std::type_identity_t<Names<E>> names, const E& x) {
    if (!key(s)) return;
    for (const auto& [word, meant] : names)
      if (meant == x) return hash_->add_text(word);
    hash_->add_text("");
  }
  void fabric(const Setting& s, const Fabric& x) { text(s, x.name); }
  void vector(const Setting& s, const Range&, const Vec3& x) {
    if (key(s)) add(x);
  }
  void box(const Setting& s, const Range&, const std::optional<std::array<Vec3, 2>>& x) {
    if (!key(s)) return;
    add(x.has_value());
    if (x)
      for (const Vec3& corner : *x) add(corner);
  }
  template <class T, class Row>
  void rows(const Setting& s, const Rows&, std::vector<T>& x, const Row& row_of) {
    if (!key(s)) return;
    add(x.size());
    for (T& row : x) row_of(*this, row);
  }
  // The columns of a row.
  void column(std::string_view, const Range&, double x) { add(x); }
  void fabric_column(std::string_view, const std::string& x) { hash_->add_text(x); }

  template <class T>
  void list(const Setting& s, std::vector<T>& x, std::size_t = 0) {
    if (!key(s)) return;
    add(x.size());
    for (T& one : x) describe(*this, one);
  }
  template <class T>
  void table(const Setting& s, std::vector<T>& x, std::string T::*name) {
    if (!key(s)) return;
    add(x.size());
    for (T& one : x) {
      hash_->add_text(one.*name);
      describe(*this, one);
    }
  }
  void heights(const Setting& s, const Range&, const std::vector<LabelHeight>& x) {
    if (!key(s)) return;
    add(x.size());
    for (const LabelHeight& one : x) {
      hash_->add_text(one.label);
      add(one.height_m);
    }
  }
  template <class T>
  void object(const Setting& s, T& x, const Shorthand& = {}) {
    if (key(s)) describe(*this, x);
  }
  template <class T>
  void object(const Setting& s, std::optional<T>& x, const Shorthand& = {}) {
    if (!key(s)) return;
    add(x.has_value());
    if (x) describe(*this, *x);
  }
  template <class Describe>
  void group(const Setting& s, const Describe& describe_members) {
    if (key(s)) describe_members(*this);
  }
  template <class Choose, class Describe>
  void alternative(std::string_view, bool chosen, const Choose&, const Describe& describe_it) {
    if (chosen) describe_it(*this);
  }
  void exactly_one(const std::vector<std::string_view>&) {}
  void at_most_one(const std::vector<std::string_view>&) {}

 private:
  // Whether it is hashed at all.
  bool key(const Setting& s) {
    if (s.in_result) hash_->add_text(s.key);
    return s.in_result;
  }
  void add(double x) { hash_->add_bytes(&x, sizeof x); }
  void add(bool x) { add(x ? 1.0 : 0.0); }
  void add(int x) { add(static_cast<double>(x)); }
  void add(std::size_t x) { add(static_cast<double>(x)); }
  void add(const Vec3& x) { hash_->add_bytes(x.data(), 3 * sizeof(double)); }
  template <class T>
  void add(const std::optional<T>& x) {
    add(x.has_value());
    if (x) add(*x);
  }

  Hash* hash_;
};

}  // namespace

std::uint64_t settings_hash(const Scene& scene) {
  Scene asked = scene;  // describe() takes a mutable object
  Hash hash;
  SettingsHash settings(hash);
  describe(settings, asked);
  return hash.value();
}

std::uint64_t input_hash(const Scene& scene, const LoadedScene& loaded) {
  std::vector<std::uint64_t> cloth;
  for (const LoadedCloth& one : loaded.cloth) cloth.push_back(one.input_hash);
  Hash hash;
  hash.add_counted(std::span<const std::uint64_t>(cloth));
  hash.add_counted(std::span<const std::uint64_t>(loaded.colliders.input_hashes));
  return combined({settings_hash(scene), hash.value(), loaded.start_hash});
}

}  // namespace toile::internal
