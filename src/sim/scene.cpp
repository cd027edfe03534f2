// sim/scene.cpp: reads a scene.  One function per object of the file, in the order of docs/scenes.md.
#include "sim/scene.hpp"

#include "io/file.hpp"
#include "sim/scene_reading.hpp"

#include <array>
#include <cmath>
#include <filesystem>

namespace toile {
namespace {

using namespace scene_reading;

// [fabric, fabric, friction]
PairFriction read_pair_friction(const Json& value) {
  if (!value.is_array() || value.array().size() != 3)
    value.fail("two names of fabrics and a number, [\"silk\", \"cotton\", 0.2]", value.describe());
  const auto name = [&](std::size_t k) {
    const Json& given = value.array()[k];
    return fabric_preset(given.string(), given.where(), given.pointer()).name;
  };
  return {name(0), name(1), number_in(value.array()[2], 0, 100)};
}

void read_world(const Json& value, Scene& scene) {
  value.allow_only({"gravity_m_per_s2", "wind_m_per_s", "air_density_kg_per_m3"});
  if (const Json* gravity = value.find("gravity_m_per_s2")) scene.gravity_m_per_s2 = vector_of(*gravity, 1000);
  if (const Json* wind = value.find("wind_m_per_s")) scene.air.wind_m_per_s = vector_of(*wind, 100);
  read_number(value, "air_density_kg_per_m3", scene.air.density_kg_per_m3, 1, 0, 1e3);
}

void read_time(const Json& value, Scene& scene) {
  value.allow_only({"fps", "seconds", "drape_seconds", "step_max_ms", "integrator", "until_still"});
  read_number(value, "fps", scene.fps, 1, 1, most_fps);
  read_number(value, "seconds", scene.seconds, 1, 0, most_seconds, true);
  scene.seconds_given = value.find("seconds") != nullptr;
  read_number(value, "drape_seconds", scene.drape_seconds, 1, 0, most_seconds);
  read_number(value, "step_max_ms", scene.step_max_s, 1e-3, 0.01, 1000);
  scene.until_still = value.boolean_or("until_still", scene.until_still);
  static constexpr std::array<std::string_view, 2> integrators = {"backward_euler", "bdf2"};
  if (const Json* integrator = value.find("integrator"))
    scene.integrator = one_of(*integrator, integrators) == 0 ? Integrator::backward_euler : Integrator::bdf2;
}

// What keeps the motion with the coarse space brakes it without (docs/theory/solver.md#what-the-tolerance-keeps).
double usual_tolerance(const Scene& scene) {
  const bool coarse =
      scene.preconditioner.value_or(Preconditioner::block_ssor_coarse) == Preconditioner::block_ssor_coarse;
  return coarse && scene.procedure == PcgProcedure::prefiltered ? Scene{}.tolerance : 1e-3;
}

void read_solver(const Json& value, Scene& scene) {
  value.allow_only({"preconditioner", "tolerance", "procedure", "newton_iterations", "relinearisations",
                    "paper_scaling", "damping_jacobian"});
  static constexpr std::array<std::string_view, 2> procedures = {"prefiltered", "paper_1998"};
  if (const Json* procedure = value.find("procedure"))
    scene.procedure = one_of(*procedure, procedures) == 0 ? PcgProcedure::prefiltered : PcgProcedure::paper_1998;
  if (const Json* iterations = value.find("newton_iterations")) {
    const double count = number_in(*iterations, 1, 3);
    if (count != std::floor(count)) iterations->fail("1, 2 or 3", iterations->describe());
    scene.newton_iterations = static_cast<int>(count);
  }
  if (const Json* relinearisations = value.find("relinearisations")) {
    const double count = number_in(*relinearisations, 0, 10);
    if (count != std::floor(count)) relinearisations->fail("a whole number from 0 to 10", relinearisations->describe());
    scene.relinearisations = static_cast<int>(count);
  }
  if (const Json* name = value.find("preconditioner")) {
    static constexpr std::array all = {Preconditioner::diagonal, Preconditioner::block_jacobi,
                                       Preconditioner::block_ssor, Preconditioner::block_ssor_coarse};
    const std::array<std::string_view, 5> names = {"auto", to_string(all[0]), to_string(all[1]), to_string(all[2]),
                                                   to_string(all[3])};
    if (const std::size_t k = one_of(*name, names); k > 0) scene.preconditioner = all[k - 1];
  }
  scene.tolerance = usual_tolerance(scene);
  read_number(value, "tolerance", scene.tolerance, 1, 1e-12, 0.5);
  scene.paper_scaling = value.boolean_or("paper_scaling", false);
  if (const Json* jacobian = value.find("damping_jacobian")) {
    static constexpr std::array<std::string_view, 2> names = {"gauss_newton", "paper"};
    scene.damping_jacobian = one_of(*jacobian, names) == 0 ? DampingJacobian::gauss_newton : DampingJacobian::paper;
  }
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file) {
  const Json root = Json::parse(text, file);
  root.allow_only({"name", "cloth", "body", "solids", "world", "time", "solver", "contact", "start", "output"});
  Scene scene;
  scene.name = root.string_or("name", std::filesystem::path(file).stem().string());
  if (scene.name.empty()) root.at("name").fail("a name", "an empty string");
  const Json& cloth = root.at("cloth");
  for (const Json& one : cloth.array()) scene.cloth.push_back(read_cloth(one, file));
  if (scene.cloth.empty()) cloth.fail("at least one cloth", "an empty array");
  for (std::size_t k = 0; k < scene.cloth.size(); ++k) {
    if (scene.cloth[k].is_sewn() != scene.cloth.front().is_sewn())
      cloth.array()[k].fail("only patterns, or no pattern, in one scene", "the other kind");
    for (std::size_t j = 0; j < k; ++j)
      if (!scene.cloth[k].name.empty() && scene.cloth[j].name == scene.cloth[k].name)
        cloth.array()[k].fail("a name that no other cloth has", '"' + printable(scene.cloth[k].name) + '"');
  }
  scene.until_still = scene.cloth.front().is_sewn();
  if (const Json* body = root.find("body")) scene.body = read_body(*body, file);
  if (const Json* solids = root.find("solids"))
    for (const Json& solid : solids->array()) scene.solids.push_back(read_solid(solid, file));
  if (!scene.cloth.front().is_sewn() && !scene.body.motion) scene.drape_seconds = 0;
  if (const Json* world = root.find("world")) read_world(*world, scene);
  if (const Json* time = root.find("time")) read_time(*time, scene);
  if (const Json* solver = root.find("solver")) read_solver(*solver, scene);
  if (const Json* contact = root.find("contact")) {
    contact->allow_only({"thickness_mm", "friction", "friction_between", "self_contact", "strict_start", "flypaper"});
    read_number(*contact, "thickness_mm", scene.contact_thickness_m, 1e-3, 0.1, 100);
    read_number(*contact, "friction", scene.contact_friction, 1, 0, 100);
    if (const Json* pairs = contact->find("friction_between"))
      for (const Json& pair : pairs->array()) scene.friction_between.push_back(read_pair_friction(pair));
    scene.self_contact = contact->boolean_or("self_contact", true);
    scene.flypaper = contact->boolean_or("flypaper", true);
    scene.strict_start = contact->boolean_or("strict_start", false);
  }
  if (const Json* start = root.find("start")) scene.start = resolve(file, *start);
  if (const Json* output = root.find("output")) {
    output->allow_only({"dir", "preview", "picture_frames"});
    scene.output_dir = output->string_or("dir", "");
    if (const Json* frames = output->find("picture_frames"))
      for (const Json& frame : frames->array())
        scene.picture_frames.push_back(static_cast<int>(number_in(frame, 0, most_seconds * most_fps)));
    if (const Json* preview = output->find("preview")) scene.preview = preview->boolean();
  }
  return scene;
}

std::string read_text_file(const std::string& path) { return read_file(path, Json::text_limit); }

}  // namespace toile
