#include "contact/feature_pairs.hpp"
#include "contact/impacts.hpp"
#include "contact/meshes.hpp"
#include "contact/proximity.hpp"
#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace toile::internal {
namespace {

using contact_test::Mesh;
using contact_test::Random;

constexpr double edge_m = 0.01, contact_m = 2.5e-3;

// Wavy layers, a gap apart; the first two are sewn along a side.
struct Layers {
  Layers(int count, double gap_m, Index cells = 14) {
    for (int layer = 0; layer < count; ++layer)
      contact_test::add_sheet(mesh, cells, cells, edge_m, Vec3(0.0013 * layer, layer * gap_m, 0.0021 * layer));
    for (Vec3& p : mesh.x) p.y() += 0.004 * std::sin(90 * p.x()) * std::cos(70 * p.z());
    const auto one = static_cast<Index>(mesh.x.size()) / count;
    merged.resize(mesh.x.size());
    for (Index i = 0; i < static_cast<Index>(mesh.x.size()); ++i)
      merged[static_cast<std::size_t>(i)] = count > 1 && i >= one && i <= one + cells ? i - one : i;
    topology = build_topology(static_cast<Index>(mesh.x.size()), mesh.triangles);
  }
  Mesh mesh;
  std::vector<Index> merged;
  Topology topology;
};

// One cloth asked with lists and, by a tree of its own, without.
class Pair {
 public:
  explicit Pair(const Layers& layers)
      : cloth_(layers.mesh.x.size(), layers.mesh.triangles, layers.topology, layers.merged),
        tree_(layers.mesh.x, layers.mesh.triangles),
        plain_tree_(tree_),
        r_(layers.mesh.x.size(), contact_m) {}

  // How many contacts there are, the same with lists as without.
  std::size_t contacts(const Vec3s& x) {
    find_cloth_contacts(cloth_, tree_, x, {}, workspace_, listed_, &pairs);
    find_cloth_contacts(cloth_, plain_tree_, x, {}, plain_workspace_, plain_);
    EXPECT_EQ(listed_.size(), plain_.size());
    for (std::size_t i = 0; i < std::min(listed_.size(), plain_.size()); ++i) {
      const ClothContact &a = listed_[i], &b = plain_[i];
      EXPECT_TRUE(a.kind == b.kind && a.particle == b.particle && a.weight == b.weight && a.normal == b.normal &&
                  a.gap_m == b.gap_m);
    }
    return plain_.size();
  }
  // Likewise of impacts.
  std::size_t impacts(const Vec3s& x, const Vec3s& end) {
    const bool all = find_impacts(cloth_, tree_, x, end, r_, impact_workspace_, listed_impacts_, {}, &pairs);
    EXPECT_EQ(find_impacts(cloth_, plain_tree_, x, end, r_, plain_impact_workspace_, plain_impacts_), all);
    EXPECT_EQ(listed_impacts_.size(), plain_impacts_.size());
    for (std::size_t i = 0; i < std::min(listed_impacts_.size(), plain_impacts_.size()); ++i) {
      const Impact &a = listed_impacts_[i], &b = plain_impacts_[i];
      EXPECT_TRUE(a.kind == b.kind && a.particle == b.particle && a.weight == b.weight && a.normal == b.normal &&
                  a.time == b.time && a.start_gap_m == b.start_gap_m && a.separation_m == b.separation_m);
    }
    return plain_impacts_.size();
  }
  // Do the lists hold for a motion?
  bool hold(const Vec3s& x, const Vec3s& end, double margin_m = 0) const {
    ParticleBoxes boxes;
    boxes.set_seen_from_mean(x, end, margin_m);
    return pairs.hold(boxes);
  }
  FeaturePairs pairs;

 private:
  ClothTopology cloth_;
  TriangleTree tree_, plain_tree_;
  ProximityWorkspace workspace_, plain_workspace_;
  ImpactWorkspace impact_workspace_, plain_impact_workspace_;
  std::vector<ClothContact> listed_, plain_;
  std::vector<Impact> listed_impacts_, plain_impacts_;
  std::vector<double> r_;
};

// Two queries, between which every particle has moved by size_m: from the third on lists are made.
void get_used_to(Pair& pair, Vec3s& x, double size_m) {
  pair.contacts(x);
  Random random(1);
  for (Vec3& p : x) p += random.vector(size_m);
  pair.contacts(x);
}

TEST(FeaturePairs, ListedPairsGiveTheContactsAndImpactsOfAWalk) {
  int held = 0, walked = 0;
  std::size_t contacts = 0, listed_impacts = 0;
  for (const int threads : {1, 3}) {
    Random random(17);
    for (int run = 0; run < 3; ++run) {
      const Layers layers(2, random.in(5e-4, 2e-3), 9);
      Pair pair(layers);
      Vec3s x = layers.mesh.x, v(x.size(), Vec3::Zero());
      double size = 1e-4;
      for (int step = 0; step < 40; ++step) {
        if (step == 15) size = 3e-3;  // too fast for lists
        if (step == 18) size = 1e-4;
        with_threads(threads, [&] {
          contacts += pair.contacts(x);
          Vec3s end = x;
          for (std::size_t i = 0; i < end.size(); ++i) {
            v[i] = 0.5 * v[i] + random.vector(size);
            end[i] += v[i] + Vec3(0.05, -0.2, 0.01);
          }
          const bool lists = pair.hold(x, end, 0.05 * contact_m);
          ++(lists ? held : walked);
          const std::size_t impacts = pair.impacts(x, end);
          if (lists) listed_impacts += impacts;
          x = end;
        });
      }
    }
  }
  EXPECT_GT(held, 100);
  EXPECT_GT(walked, 30);
  EXPECT_GT(contacts, 50'000U);
  EXPECT_GT(listed_impacts, 1000U);
}

TEST(FeaturePairs, HoldForClothThatMovesAsAWholeAndNotForAParticleThatLeavesItsBox) {
  const Layers layers(2, 2e-3);
  Pair pair(layers);
  Vec3s x = layers.mesh.x;
  EXPECT_FALSE(pair.hold(x, x)) << "there are none yet";
  get_used_to(pair, x, 5e-5);
  ASSERT_TRUE(pair.hold(x, x));
  Vec3s end = x;
  for (Vec3& p : end) p += Vec3(2, -1, 0.5);
  EXPECT_TRUE(pair.hold(x, end));
  EXPECT_TRUE(pair.hold(end, end));
  for (const double by_m : {-0.02, 0.02}) {
    end = x;
    end[100].y() += by_m;
    EXPECT_FALSE(pair.hold(x, end));
    EXPECT_FALSE(pair.hold(end, x));
    pair.impacts(x, end);
  }
  EXPECT_GT(pair.contacts(end), 0U);
}

// Of the last steps only: what has come to rest gets small boxes again.
TEST(FeaturePairs, ThereAreNoneWhileClothMovesByMuchOfItsEdgesInAStep) {
  const Layers layers(2, 2e-3);
  Pair pair(layers);
  Vec3s x = layers.mesh.x;
  get_used_to(pair, x, 0.1 * edge_m);
  EXPECT_FALSE(pair.hold(x, x));
  for (int step = 0; step < 20; ++step) pair.contacts(x);
  EXPECT_TRUE(pair.hold(x, x));
}

TEST(FeaturePairs, ThereAreNoneWhereNearlyEverythingIsNear) {
  const Layers layers(40, 1e-4, 5);
  Pair pair(layers);
  Vec3s x = layers.mesh.x;
  get_used_to(pair, x, 1e-5);
  EXPECT_FALSE(pair.hold(x, x));
  for (int step = 0; step < 20; ++step) {
    EXPECT_GT(pair.contacts(x), 1000U);
    EXPECT_FALSE(pair.hold(x, x));
  }
  // Once the layers are apart there are some.
  x = Layers(40, 0.05, 5).mesh.x;
  for (int step = 0; step < 60; ++step) pair.contacts(x);
  EXPECT_TRUE(pair.hold(x, x));
}

// So many that not all are reported: which of them are is the walk's to say.
TEST(FeaturePairs, MoreImpactsThanAreWorthCorrectingAreTheSameToo) {
  const Layers layers(2, 3e-4, 80);
  Pair pair(layers);
  Vec3s x = layers.mesh.x;
  get_used_to(pair, x, 2e-4);
  Vec3s end = x;
  for (std::size_t i = 0; i < x.size(); ++i) end[i].y() += i < x.size() / 2 ? 5e-4 : -5e-4;
  EXPECT_TRUE(pair.hold(x, end, 0.05 * contact_m));
  EXPECT_GT(pair.impacts(x, end), most_impacts(x.size()));
}

TEST(FeaturePairs, OfAnotherClothAreForgotten) {
  const Layers small(1, 0, 4), large(2, 1e-3, 6);
  Pair first(small), second(large);
  Vec3s x = small.mesh.x;
  get_used_to(first, x, 1e-5);
  ASSERT_TRUE(first.hold(x, x));
  second.pairs = first.pairs;
  EXPECT_GT(second.contacts(large.mesh.x), 0U);
  EXPECT_EQ(second.impacts(large.mesh.x, large.mesh.x), 0U);
}

TEST(FeaturePairs, ClothWithoutParticlesHasNone) {
  const Layers none(1, 0, 0);
  Pair pair(none);
  Vec3s x = none.mesh.x;
  for (int step = 0; step < 4; ++step) EXPECT_EQ(pair.contacts(x), 0U);
  EXPECT_EQ(pair.impacts(x, x), 0U);
}

}  // namespace
}  // namespace toile::internal
