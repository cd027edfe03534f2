// A step allocates nothing once its buffers have grown to the contacts at hand, and all of it together is not too much.  Counted at
// malloc, below operator new, because Eigen's matrices call malloc themselves.  One thread: what TBB takes for its own tasks is not ours.
#include "assembly/air.hpp"
#include "assembly/pressure.hpp"
#include "support/bodies.hpp"
#include "support/run_cloth.hpp"

#include "core/parallel.hpp"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
namespace {
bool counting = false;
long allocations = 0;
long held_bytes = 0, most_held_bytes = 0;  // of what was allocated and freed while counting
void* count(void* memory) {
  if (!counting) return memory;
  ++allocations;
  held_bytes += static_cast<long>(malloc_usable_size(memory));
  most_held_bytes = std::max(most_held_bytes, held_bytes);
  return memory;
}
void uncount(void* memory) {
  if (counting) held_bytes -= static_cast<long>(malloc_usable_size(memory));
}
}  // namespace

// The C library's own names; what is defined here takes the place of malloc in the whole process.
extern "C" {
void* __libc_malloc(std::size_t) noexcept;
void* __libc_calloc(std::size_t, std::size_t) noexcept;
void* __libc_realloc(void*, std::size_t) noexcept;
void* __libc_memalign(std::size_t, std::size_t) noexcept;
void __libc_free(void*) noexcept;

void* malloc(std::size_t size) noexcept { return count(__libc_malloc(size)); }
void* calloc(std::size_t number, std::size_t size) noexcept { return count(__libc_calloc(number, size)); }
void* realloc(void* old, std::size_t size) noexcept {
  uncount(old);
  return count(__libc_realloc(old, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return count(__libc_memalign(alignment, size));
}
void free(void* memory) noexcept {
  uncount(memory);
  __libc_free(memory);
}
}

namespace toile::internal {
namespace {

using test::ClothRun;
using test::Sheet;

// Allocations of each of `frames` frames.
std::vector<long> allocations_of_frames(ClothRun& run, int frames) {
  std::vector<long> counts;
  counts.reserve(static_cast<std::size_t>(frames));
  with_threads(1, [&] {
    for (int f = 0; f < frames; ++f) {
      allocations = 0;
      counting = true;
      run.frame();
      counting = false;
      counts.push_back(allocations);
    }
  });
  return counts;
}

TEST(Allocation, IsSeenByThisTest) {
  counting = true;
  allocations = 0;
  std::vector<double> some(100);
  Eigen::VectorXd other(100);
  counting = false;
  EXPECT_EQ(allocations, 2) << some.size() + static_cast<std::size_t>(other.size());
}

long sum(const std::vector<long>& counts, std::size_t from) {
  return std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(from), counts.end(), 0L);
}

TEST(Allocation, NoneAfterTheFirstStepOfASwingingSheet) {
  ClothRun run(test::equilateral_sheet(0.4, 0.4, 0.02), Fabric{});
  run.step.rows.cloth_cloth = false;
  run.pin(0);
  run.pin(20);
  run.start();
  EXPECT_EQ(sum(allocations_of_frames(run, 30), 1), 0);
}

TEST(Allocation, NoneAfterTheFirstStepOfASheetLyingOnABody) {
  BodySurface slab = test::tilted_slab(1, 0.2, 0);
  Sheet sheet = test::equilateral_sheet(0.2, 0.2, 0.02);
  for (Vec3& p : sheet.x) p += Vec3(-0.1, 0.0025, 0.1);
  ClothRun run(sheet, Fabric{});
  run.world.body = &slab;
  run.start();
  const std::vector<long> counts = allocations_of_frames(run, 30);
  EXPECT_GT(run.stepper->integrator().body_constraints().touching(), 50);
  EXPECT_EQ(sum(counts, 1), 0);
}

TEST(Allocation, AStepUnderForcesTakesNoMemory) {
  ClothRun run(test::equilateral_sheet(0.4, 0.4, 0.02), Fabric{});
  run.step.rows.cloth_cloth = false;
  run.add_force<Air>(AirOptions{Vec3(2, 0, 1)});
  run.add_force<Pressure>([](double end_s, std::span<double> panel_Pa) { panel_Pa[0] = end_s > 0.5 ? 0.5 : 0; },
                          std::size_t{1});
  run.pin(0);
  run.pin(20);
  run.start();
  const std::vector<long> counts = allocations_of_frames(run, 30);
  EXPECT_GT(counts[0], 0);
  const auto takes = [](long count) { return count > 0; };
  EXPECT_LE(std::count_if(counts.begin() + 1, counts.end(), takes), 1) << "but the first under pressure";
  EXPECT_EQ(sum(counts, 20), 0);
}

// Contacts come and go for good while the sheet folds over the ball: buffers double, so that their growth ends.
TEST(Allocation, OnlyForGrowthOfContactsOfASheetFoldingOverABall) {
  BodySurface ball = test::sphere(Vec3(0, -0.1, 0), 0.1, 4);
  Sheet sheet = test::equilateral_sheet(0.3, 0.3, 0.02);
  for (Vec3& p : sheet.x) p += Vec3(-0.15, 0.004, 0.15);
  ClothRun run(sheet, Fabric{});
  run.world.body = &ball;
  run.pin(136);  // the middle: it stays on the ball
  run.start();
  const std::vector<long> counts = allocations_of_frames(run, 60);
  EXPECT_GT(run.stepper->integrator().body_constraints().touching(), 10);
  EXPECT_LE(sum(counts, 1), 150);
  EXPECT_LE(sum(counts, 40), 4);
}

// The mesh is fine beside the cloth's thickness, so that every vertex has dozens of triangles within the range of contact.
TEST(Allocation, AFineSheetOverABallTakesNoMoreThanItDid) {
  // 6220 with hinges, 6840 with plates, and room for another library.
  for (const auto& [element, most_bytes_per_particle] :
       {std::pair{BendElement::hinge, 6500L}, std::pair{BendElement::plate, 7100L}}) {
    BodySurface ball = test::sphere(Vec3(0, -0.1, 0), 0.1, 4);
    Sheet sheet = test::equilateral_sheet(0.2, 0.2, 0.0035);
    for (Vec3& p : sheet.x) p += Vec3(-0.1, 0.004, 0.1);
    const auto particles = static_cast<long>(sheet.x.size());
    ModelOptions options;
    options.bend_element = element;
    held_bytes = most_held_bytes = 0;
    counting = true;
    {
      ClothRun run(sheet, test::elastic_cotton(), options);
      run.world.body = &ball;
      run.start();
      with_threads(1, [&] {
        for (int f = 0; f < 3; ++f) run.frame();
        static_cast<void>(run.stepper->integrator().contact_rows().layer_gap(run.state.x));
      });
    }
    counting = false;
    EXPECT_LE(most_held_bytes, most_bytes_per_particle * particles) << most_held_bytes / particles << " per particle";
  }
}

}  // namespace
}  // namespace toile::internal
#endif
