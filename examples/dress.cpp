// A skirt is sewn around a woman, who then sways; the frames are written as files that other programs read.
#include <toile/run.hpp>

#include <cstdio>

int main() {
  toile::Cloth skirt = toile::Cloth::from_pattern("patterns/short_skirt.json", {.edge_m = 0.05});
  skirt.set_fabric(toile::fabric("cotton"));
  toile::Simulation sim(skirt, toile::Body::mannequin("dancer", "dance"));
  const toile::DressReport worn = sim.dress();
  std::printf("%s\n", worn.explain().c_str());
  if (!worn.ok()) return 1;

  toile::RunWriter run("out/skirt", sim);
  for (int frame = 0; frame < 30; ++frame) {
    if (const toile::StepReport step = sim.advance(1.0 / 30); !step.ok()) {
      std::fprintf(stderr, "%s\n", step.explain().c_str());
      return 1;
    }
    run.add(sim);
  }
  const toile::Verdict verdict = run.finish();
  std::printf("%s\n", verdict.explain().c_str());
  return verdict.pass ? 0 : 1;
}
