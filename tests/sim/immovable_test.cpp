// What has a member that points at another member, or gave away a closure over `this`, must stay where it is: moved or copied, it would go
// on with the parts of what it was made from.  A new class of that kind belongs into this list; those inside a .cpp say it there.
#include "core/tasks.hpp"
#include "core/team.hpp"
#include "dress/dressing.hpp"
#include "dress/outfit_run.hpp"
#include "dress/sewing.hpp"
#include "preview/ray_scene.hpp"
#include "sim/simulation.hpp"
#include "solver/modified_pcg.hpp"
#include "solver/step_solver.hpp"
#include "step/adaptive_step.hpp"
#include "step/implicit_euler.hpp"
#include "support/run_cloth.hpp"

#include <type_traits>

namespace toile::internal {
namespace {

template <class... T>
constexpr bool stay_in_place = ((!std::is_copy_constructible_v<T> && !std::is_copy_assignable_v<T> &&
                                 !std::is_move_constructible_v<T> && !std::is_move_assignable_v<T>)&&...);

static_assert(stay_in_place<Tasks>, "its tasks say to order_ that they are done");
static_assert(stay_in_place<Team>, "its tasks join it");
static_assert(stay_in_place<ModifiedPcg<float>, ModifiedPcg<double>>, "team_ is alone_ or all_");
static_assert(stay_in_place<StepSolver>, "its systems point at its matrices");
static_assert(stay_in_place<ImplicitEuler>, "stretch_ points at elements_, solver_ is one that stays");
static_assert(stay_in_place<AdaptiveStep>, "has an integrator");
static_assert(stay_in_place<Sewing>, "stepper_ points at model_ and world_, world_.springs is a closure over it");
static_assert(stay_in_place<Dressing>, "sewing_ points at panels_");
static_assert(stay_in_place<OutfitRun>, "stepper_ points at model_ and world_, which has closures over it");
static_assert(stay_in_place<Simulation>, "run_ points at scene_, outfit_ and body_, and asks stop() of it");
static_assert(stay_in_place<RayScene>, "the ray tracer points at meshes_");
static_assert(stay_in_place<test::ClothRun>, "stepper points at model and world");

// Those that point only at what is not theirs may move; what they point at is named in their headers and must stay.
static_assert(std::is_move_constructible_v<Tangles> && std::is_move_constructible_v<BodyConstraints> &&
              std::is_move_constructible_v<ContactRows> && std::is_move_constructible_v<SafeFilter> &&
              std::is_move_constructible_v<TriangleTree> && std::is_move_constructible_v<Elements>);

// A temporary that would be gone when it is needed.
static_assert(!std::is_constructible_v<Elements, ClothModel>);
static_assert(!std::is_constructible_v<LinearSystem<float>, BlockMatrix<float>>);

}  // namespace
}  // namespace toile::internal
