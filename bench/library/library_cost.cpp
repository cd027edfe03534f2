// The overhead of the library: the same sheet by the engine's frames and by toile::Simulation, in turns of ten frames, in one run.
//
//   toile_library_cost [rounds]      prints both times of each round and the ratio of the sums
#include "sim/simulation.hpp"
#include "toile/simulation.hpp"

#include "core/stopwatch.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

constexpr int frames_in_turn = 10;
constexpr const char* scene_text = R"({"cloth": [{"grid": {"width_m": 1, "height_m": 1, "edge_m": 0.0214},
  "placement": {"translation_m": [0, 0.02, 0], "rotation_deg": [-90, 0, 0]}}],
  "body": {"cylinder": {"radius_m": 0.2, "height_m": 0.5}}})";

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 10;
  const toile::internal::Scene scene = toile::internal::parse_scene(scene_text, "bench");
  toile::internal::SimulationObserver nobody;
  toile::internal::Simulation engine(scene, toile::internal::load_scene(scene, toile::internal::read_text_file), {},
                                     nobody);
  engine.put_on();
  engine.begin();

  const std::string path = (std::filesystem::temp_directory_path() / "toile_library_cost.json").string();
  if (std::FILE* file = std::fopen(path.c_str(), "w")) {
    std::fputs(scene_text, file);
    std::fclose(file);
  }
  toile::Simulation library = toile::Simulation::from_scene(path);
  std::remove(path.c_str());

  double engine_s = 0, library_s = 0, lowest = 0;
  for (int round = 0; round < rounds; ++round) {
    // They take turns in going first: the second one finds warm caches.
    for (int turn = 0; turn < 2; ++turn) {
      const toile::internal::Stopwatch watch;
      const bool by_engine = (turn + round) % 2 == 0;
      for (int frame = 0; frame < frames_in_turn; ++frame) {
        if (by_engine) {
          engine.live().frame();
        } else {
          library.advance(1 / scene.fps);
          lowest = library.positions_m()[0][1];  // read as a caller would
        }
      }
      (by_engine ? engine_s : library_s) += watch.seconds();
    }
    std::printf("%3d frames  engine %.3f s  library %.3f s\n", (round + 1) * frames_in_turn, engine_s, library_s);
  }
  toile::internal::Hash bits;
  bits.add(std::span<const toile::internal::Vec3>(engine.outfit().state.x));
  bits.add(std::span<const toile::internal::Vec3>(engine.outfit().state.v));
  std::printf("%zu vertices, first at %.3f m, the same bits: %s\nlibrary / engine %.4f\n", library.positions_m().size(),
              lowest, bits.hex() == library.state_hash() ? "yes" : "NO", library_s / engine_s);
}
