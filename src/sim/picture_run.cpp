#include "sim/picture_run.hpp"

#include "core/error.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "preview/preview.hpp"
#include "verify/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace toile {
namespace {

struct Take {  // one cache and the surface that it moves
  ObjMesh obj;
  std::vector<std::array<Vec2, 3>> uv;
  std::unique_ptr<Pc2Reader> frames;

  bool open(const std::filesystem::path& directory, const std::string& name) {
    const std::string obj_path = (directory / (name + ".obj")).string();
    if (!std::filesystem::exists(obj_path)) return false;
    obj = load_obj(obj_path);
    frames = std::make_unique<Pc2Reader>((directory / (name + ".pc2")).string());
    if (static_cast<std::size_t>(frames->points()) != obj.positions.size())
      throw InputError(printable((directory / (name + ".pc2")).string()), "points",
                       std::to_string(obj.positions.size()), std::to_string(frames->points()));
    if (frames->samples() < 1)
      throw InputError(printable((directory / (name + ".pc2")).string()), "samples", "at least one", "0");
    for (const auto& corners : obj.texcoord) {
      std::array<Vec2, 3> three{Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)};
      for (std::size_t k = 0; k < 3; ++k)
        if (corners[k] >= 0) three[k] = obj.texcoords[static_cast<std::size_t>(corners[k])];
      uv.push_back(three);
    }
    return true;
  }
};

struct Shot {
  const Take* take;
  int frame;
};

void grow(std::array<Vec3, 2>& box, const Vec3s& x) {
  for (const Vec3& p : x) {
    if (!p.allFinite()) continue;
    box[0] = box[0].cwiseMin(p);
    box[1] = box[1].cwiseMax(p);
  }
}

// Front, side and back of the cloth as it is; of the body only as much as the cloth reaches, and a little more.
Image three_views(const PreviewScene& scene, const Vec3s& cloth, const RenderOptions& options) {
  std::array<Vec3, 2> box{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  grow(box, cloth);
  const Vec3 margin = 0.08 * (box[1] - box[0]);
  std::vector<Image> views;
  const double aspect = static_cast<double>(options.width) / options.height;
  for (const double azimuth_deg : {0.0, 90.0, 180.0}) {
    views.push_back(render(scene, frame_subject(box[0] - margin, box[1] + margin, azimuth_deg, 8, aspect), options));
  }
  const std::array<std::string, 3> captions{"front", "side", "back"};
  return contact_sheet(views, captions, 3);
}

void add_shots(const Take& take, int count, std::vector<Shot>& shots) {
  const int last = take.frames->samples() - 1;
  for (int k = 0; k < count; ++k)
    shots.push_back({&take, count > 1 ? static_cast<int>(std::lround(double(k) * last / (count - 1))) : last});
}

}  // namespace

void picture_run(const std::string& directory, const PictureOptions& options,
                 const std::function<void(double)>& progress, const std::function<bool()>& stop) {
  const std::filesystem::path folder(directory);
  Take sewing, cloth, body;
  const bool sewn = sewing.open(folder, "sewing"), draped = cloth.open(folder, "cloth"),
             dressed = body.open(folder, "body");
  if (!sewn && !draped) throw IoError((folder / "cloth.obj").string(), "no such file: this directory holds no run");

  PreviewScene scene;
  Vec3s x, body_x = dressed ? body.obj.positions : Vec3s{};
  scene.body_triangles = body.obj.triangles;
  scene.body_positions = body_x;
  scene.cloths.resize(1);
  const auto show = [&](const Shot& shot) {
    shot.take->frames->read(shot.frame, x);
    if (dressed && shot.take == &cloth) body.frames->read(std::min(shot.frame, body.frames->samples() - 1), body_x);
    scene.cloths[0].triangles = shot.take->obj.triangles;
    scene.cloths[0].uv = shot.take->uv;
    scene.cloths[0].positions = x;
    scene.body_positions = body_x;
  };
  std::array<Vec3, 2> box{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  for (const Take* take : {&sewing, &cloth}) {
    if (!take->frames) continue;
    for (int k = 0; k < take->frames->samples(); k += std::max(1, take->frames->samples() / 8)) {
      take->frames->read(k, x);
      grow(box, x);
    }
    take->frames->read(take->frames->samples() - 1, x);
    grow(box, x);
  }
  std::array<Vec3, 2> all = box;
  grow(all, body_x);
  scene.ground_y_m = all[1].y() > all[0].y() ? all[0].y() : 0;

  const Take& last = draped ? cloth : sewing;
  show({&last, last.frames->samples() - 1});
  const bool finite = std::all_of(x.begin(), x.end(), [](const Vec3& p) { return p.allFinite(); });
  if (draped && finite) {
    const auto red = [&](const std::vector<Crossing>& crossings, const Vec3s& ends) {
      for (const Crossing& c : crossings)
        scene.red_segments.push_back(
            {ends[static_cast<std::size_t>(c.edge[0])], ends[static_cast<std::size_t>(c.edge[1])]});
    };
    red(find_cloth_crossings(cloth.obj.triangles, x), x);
    if (dressed)
      for (const Crossing& c : find_body_crossings(cloth.obj.triangles, x, body.obj.triangles, body_x))
        red({c}, c.edge_of_body ? body_x : x);
  }
  RenderOptions sheet;
  sheet.width = options.sheet_width;
  sheet.height = options.sheet_height;
  sheet.samples = options.sheet_samples;
  write_png((folder / "preview.png").string(), three_views(scene, x, sheet));
  scene.red_segments.clear();
  if (progress) progress(0.1);

  // Sewing takes two fifths of the film, the rest is the cloth's.
  std::vector<Shot> shots;
  const int budget = options.most_film_frames;
  if (sewn) add_shots(sewing, std::min((sewing.frames->samples() + 1) / 2, draped ? 2 * budget / 5 : budget), shots);
  if (draped)
    add_shots(cloth, std::min((cloth.frames->samples() + 1) / 2, budget - static_cast<int>(shots.size())), shots);
  RenderOptions film;
  film.width = options.film_width;
  film.height = options.film_height;
  film.samples = options.film_samples;
  Renderer renderer(film);
  const double aspect = static_cast<double>(film.width) / film.height;
  // The garment fills the picture: of a body only as much is shown as the cloth reaches, and a little more.
  const Vec3 margin = Vec3::Constant(0.05);
  const Camera camera = frame_subject(box[0] - margin, box[1] + margin, 25, 8, aspect);
  write_mp4((folder / "preview.mp4").string(), static_cast<int>(shots.size()), options.film_fps, [&](int k) {
    if (stop && stop()) throw Error(ExitCode::interrupted, "interrupted while the film was made");
    show(shots[static_cast<std::size_t>(k)]);
    Image image = renderer.render(scene, camera);
    if (progress) progress(0.1 + 0.9 * (k + 1) / static_cast<double>(shots.size()));
    return image;
  });
}

}  // namespace toile
