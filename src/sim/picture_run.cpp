#include "sim/picture_run.hpp"

#include "core/error.hpp"
#include "io/json.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/run_folder.hpp"
#include "preview/cloth_look.hpp"
#include "preview/looks.hpp"
#include "preview/preview.hpp"
#include "sim/panel_fabrics.hpp"
#include "sim/picture_state.hpp"
#include "verify/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace toile::internal {
namespace {

struct Take {  // one cache and the surface that it moves
  SurfaceMesh obj;
  // One per object of the file: its triangles, their coordinates, and their panels.
  struct Piece {
    std::vector<Triangle> triangles;
    std::vector<std::array<Vec2, 3>> uv;
    std::vector<Index> panel;
    std::vector<Vec3> colours;  // by rules; empty: the garment's
  };
  std::vector<Piece> pieces;
  std::vector<ClothPart> panels;
  std::vector<ClothLook> looks;  // [panel]; empty: technical
  std::unique_ptr<Pc2Reader> frames;

  bool open(const std::filesystem::path& directory, const std::string& name) {
    const std::string obj_path = (directory / (name + ".obj")).string();
    if (!std::filesystem::exists(obj_path)) return false;
    obj = load_obj(obj_path);
    settle_groups(obj, directory.string());
    frames = std::make_unique<Pc2Reader>((directory / (name + ".pc2")).string(), Pc2End::cut);
    if (static_cast<std::size_t>(frames->points()) != obj.positions.size())
      throw InputError(printable((directory / (name + ".pc2")).string()), "points",
                       std::to_string(obj.positions.size()), std::to_string(frames->points()));
    if (frames->samples() < 1)
      throw InputError(printable((directory / (name + ".pc2")).string()), "samples", "at least one", "0");
    pieces.resize(std::max<std::size_t>(1, obj.object_names.size()));
    for (std::size_t t = 0; t < obj.triangles.size(); ++t) {
      Piece& piece = pieces[obj.object.empty() ? 0 : static_cast<std::size_t>(obj.object[t])];
      piece.triangles.push_back(obj.triangles[t]);
      piece.panel.push_back(panel_of_triangle(t));
      if (obj.texcoord.empty()) continue;
      std::array<Vec2, 3> three{Vec2(0, 0), Vec2(0, 0), Vec2(0, 0)};
      for (std::size_t k = 0; k < 3; ++k)
        if (obj.texcoord[t][k] >= 0) three[k] = obj.texcoords[static_cast<std::size_t>(obj.texcoord[t][k])];
      piece.uv.push_back(three);
    }
    return true;
  }

  // The first garment in its fabric's own colour, others dyed, and all by `rules`.
  void colour(PictureStyle style, const Looks* rules) {
    std::vector<std::optional<Vec3f>> given(panels.size());
    for (std::size_t p = 0; p < panels.size(); ++p) {
      const std::size_t k = static_cast<std::size_t>(object_of_panel_[p]) % garment_colours.size();
      const ClothLook fabric = look_of(panels[p].fabric);
      const ClothLook own = k == 0 ? fabric : dyed(fabric, garment_colours[k].cast<float>());
      if (rules) given[p] = rules->colour_of(panels[p], own);
      if (style == PictureStyle::studio) looks.push_back(rules ? rules->look_of(panels[p], own) : own);
    }
    for (std::size_t k = 0; rules && k < pieces.size(); ++k) {
      const Vec3& other = garment_colours[k % garment_colours.size()];
      for (const Index p : pieces[k].panel) {
        const auto& colour = given[static_cast<std::size_t>(p)];
        pieces[k].colours.push_back(colour ? Vec3(colour->cast<double>()) : other);
      }
    }
  }

  // As they are numbered there: sewing.obj has but one of a run's garments.
  void number_garments_as(const Take& other) {
    const std::vector<std::string>& names = other.obj.object_names;
    for (ClothPart& panel : panels) {
      const auto found = std::find(names.begin(), names.end(), panel.garment_name);
      if (found != names.end()) panel.garment = static_cast<Index>(found - names.begin());
    }
  }

 private:
  Index panel_of_triangle(std::size_t t) {
    const Index object = obj.object.empty() ? 0 : obj.object[t], group = obj.group.empty() ? -1 : obj.group[t];
    const auto [known, is_new] = numbers_.try_emplace({object, group}, static_cast<Index>(panels.size()));
    if (is_new) {
      const auto name = [](const std::vector<std::string>& names, Index k) {
        return k < 0 || static_cast<std::size_t>(k) >= names.size() ? std::string()
                                                                    : names[static_cast<std::size_t>(k)];
      };
      panels.push_back(
          {object, name(obj.object_names, object), name(obj.group_names, group), name(obj.group_material, group)});
      object_of_panel_.push_back(object);
    }
    return known->second;
  }

  std::map<std::pair<Index, Index>, Index> numbers_;
  std::vector<Index> object_of_panel_;
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

// Front, side and back views of the surroundings of some points.
Image three_views(const PreviewScene& scene, const Vec3s& points, double least_margin_m, const RenderOptions& options) {
  std::array<Vec3, 2> box{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  grow(box, points);
  const Vec3 margin = (0.08 * (box[1] - box[0])).cwiseMax(least_margin_m);
  std::vector<Image> views;
  const double aspect = static_cast<double>(options.width) / options.height;
  for (const double azimuth_deg : {0.0, 90.0, 180.0}) {
    views.push_back(render(scene, frame_subject(box[0] - margin, box[1] + margin, azimuth_deg, 8, aspect), options));
  }
  const std::array<std::string, 3> captions{"front", "side", "back"};
  return contact_sheet(views, captions, 3);
}

// The edges that pass through a triangle.  Positions are finite; the body may be empty.
std::vector<std::array<Vec3, 2>> crossing_edges(const Take& cloth, const Vec3s& x, const Take& body,
                                                const Vec3s& body_x) {
  std::vector<std::array<Vec3, 2>> edges;
  const auto add = [&](const std::vector<Crossing>& crossings) {
    for (const Crossing& c : crossings) {
      const Vec3s& ends = c.edge_of_body ? body_x : x;
      edges.push_back({ends[static_cast<std::size_t>(c.edge[0])], ends[static_cast<std::size_t>(c.edge[1])]});
    }
  };
  add(find_cloth_crossings(cloth.obj.triangles, x));
  add(find_body_crossings(cloth.obj.triangles, x, body.obj.triangles, body_x));
  return edges;
}

// The gaps of open seams (report.json); none in a run without a report.
std::vector<std::array<Vec3, 2>> open_seams(const std::filesystem::path& folder, const Vec3s& x) {
  std::vector<std::array<Vec3, 2>> lines;
  const std::string path = (folder / "report.json").string();
  if (!std::filesystem::exists(path)) return lines;
  const Json report = Json::parse(read_file(path, Json::text_limit), printable(path));
  const Json* seams = report.find("open_seams");
  if (seams == nullptr) return lines;
  for (const Json& seam : seams->array()) {
    for (const Json& pair : seam.at("vertices").array()) {
      std::vector<Vec3> ends;
      for (const Json& end : pair.array())
        if (const double i = end.number(); i >= 0 && i < static_cast<double>(x.size()))
          ends.push_back(x[static_cast<std::size_t>(i)]);
      if (ends.size() == 2) lines.push_back({ends[0], ends[1]});
    }
  }
  return lines;
}

// `count` evenly spaced frames of first ... last.
void add_shots(const Take& take, int first, int last, int count, std::vector<Shot>& shots) {
  for (int k = 0; k < count; ++k)
    shots.push_back(
        {&take, count > 1 ? first + static_cast<int>(std::lround(double(k) * (last - first) / (count - 1))) : last});
}

// The surfaces of the take at those positions.
std::vector<PreviewCloth> cloths_of(const Take& take, const Vec3s& x) {
  std::vector<PreviewCloth> cloths;
  for (std::size_t k = 0; k < take.pieces.size(); ++k) {
    const Take::Piece& piece = take.pieces[k];
    cloths.push_back({piece.triangles, piece.uv, x, garment_colours[k % garment_colours.size()], piece.colours,
                      take.looks, piece.panel});
  }
  return cloths;
}

// The last frame before the body moves, from report.json; -1: it never does.
struct Timing {
  int motion_first = -1;
  double fps = 30;
};
Timing timing_of(const std::filesystem::path& folder) {
  Timing timing;
  const std::string path = (folder / "report.json").string();
  if (!std::filesystem::exists(path)) {
    if (const auto run = read_unfinished_run(folder.string()); run && run->fps > 0)
      timing = {run->motion_first_frame, run->fps};
    return timing;
  }
  const Json report = Json::parse(read_file(path, Json::text_limit), printable(path));
  if (const Json* fps = report.find("fps")) timing.fps = fps->number();
  const Json* motion = report.find("motion");
  if (motion != nullptr && motion->is_object())
    timing.motion_first = static_cast<int>(motion->at("first_frame").number());
  return timing;
}

// 30 cm around a point, from the front and a little from its left.
Image close_up(const PreviewScene& scene, const Vec3& point) {
  RenderOptions options;
  options.width = options.height = 1080;
  options.samples = 32;
  options.display_edge_m = 0.0015;
  const Vec3 half = Vec3::Constant(0.09);
  return render(scene, frame_subject(point - half, point + half, 20, 12, 1), options);
}

constexpr int turntable_frames = 90;
constexpr double turntable_fps = 15;

// Of the cloth at x.
void film_turntable(const std::string& path, const PreviewScene& scene, const Vec3s& x, const RenderOptions& options,
                    const std::function<bool()>& stop) {
  std::array<Vec3, 2> box{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  grow(box, x);
  const Vec3 margin = Vec3::Constant(0.05);
  const std::vector<Camera> cameras = turntable(box[0] - margin, box[1] + margin, 8,
                                                static_cast<double>(options.width) / options.height, turntable_frames);
  Renderer renderer(options);
  write_mp4(
      path, turntable_frames, turntable_fps,
      [&](int k) {
        if (stop && stop()) throw Error(ErrorKind::interrupted, "interrupted while the film was made");
        return renderer.render(scene, cameras[static_cast<std::size_t>(k)]);
      },
      stop);
}

}  // namespace

PictureOptions studio_pictures() {
  PictureOptions options;
  options.style = PictureStyle::studio;
  options.sheet_width = 618;
  options.sheet_height = 1032;
  options.sheet_samples = 16;
  options.film_width = 720;
  options.film_height = 960;
  options.film_samples = 8;
  options.film_fps = 30;
  options.most_film_frames = 120;
  options.most_motion_frames = std::numeric_limits<int>::max();
  return options;
}

void picture_run(const std::string& directory, const PictureOptions& options,
                 const std::function<void(double)>& progress, const std::function<bool()>& stop) {
  require_pictures();
  if (options.close_up_m && !options.close_up_m->allFinite())
    throw InputError("", "close-up", "a point of three finite numbers", "one that is not finite");
  const std::filesystem::path folder(directory);
  Take sewing, cloth, body;
  const bool sewn = sewing.open(folder, "sewing"), draped = cloth.open(folder, "cloth"),
             dressed = body.open(folder, "body");
  if (!sewn && !draped) throw IoError((folder / "cloth.obj").string(), "no such file: this directory holds no run");
  if (draped) sewing.number_garments_as(cloth);
  if (options.looks) options.looks->check(draped ? cloth.panels : sewing.panels);
  for (Take* take : {&sewing, &cloth}) take->colour(options.style, options.looks.get());

  PreviewScene scene;
  Vec3s x, body_x = dressed ? body.obj.positions : Vec3s{};
  scene.body_triangles = body.obj.triangles;
  scene.body_positions = body_x;
  // The thin person around whom the garment was sewn replaces the first vertices of the body.
  const std::filesystem::path thin = folder / "sewing_body.obj";
  Vec3s sewn_around = body_x;
  if (dressed && std::filesystem::exists(thin)) {
    const Vec3s person = load_obj(thin.string()).positions;
    if (person.size() <= sewn_around.size()) std::copy(person.begin(), person.end(), sewn_around.begin());
  }
  const auto show = [&](const Shot& shot) {
    shot.take->frames->read(shot.frame, x);
    if (dressed && shot.take == &cloth) body.frames->read(std::min(shot.frame, body.frames->samples() - 1), body_x);
    scene.cloths = cloths_of(*shot.take, x);
    scene.body_positions = shot.take == &sewing ? sewn_around : body_x;
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
  if (draped && finite) scene.red_segments = crossing_edges(cloth, x, body, body_x);
  if (draped && finite)
    for (const auto& line : open_seams(folder, x)) scene.red_segments.push_back(line);
  RenderOptions sheet;
  sheet.width = options.sheet_width;
  sheet.height = options.sheet_height;
  sheet.samples = options.sheet_samples;
  write_png((folder / "preview.png").string(), three_views(scene, x, 0, sheet));
  scene.red_segments.clear();
  if (options.close_up_m) write_png((folder / "close-up.png").string(), close_up(scene, *options.close_up_m));
  RenderOptions film;
  film.width = options.film_width;
  film.height = options.film_height;
  film.samples = options.film_samples;
  film.display_edge_m = options.film_edge_m;
  if (options.turntable) film_turntable((folder / "turntable.mp4").string(), scene, x, film, stop);
  const Timing timing = timing_of(folder);
  if (draped && !options.frames.empty()) {
    std::vector<Image> pictures;
    std::vector<std::string> captions;
    const Vec3 margin = Vec3::Constant(0.05);
    std::array<Vec3, 2> whole{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
    std::vector<Shot> chosen;
    for (const int frame : options.frames) {
      chosen.push_back({&cloth, std::clamp(std::max(0, timing.motion_first) + frame, 0, cloth.frames->samples() - 1)});
      show(chosen.back());
      grow(whole, x);
      captions.push_back("frame " + std::to_string(frame));
    }
    const double aspect = static_cast<double>(sheet.width) / sheet.height;
    const Camera camera = frame_subject(whole[0] - margin, whole[1] + margin, 20, 8, aspect);
    for (const Shot& shot : chosen) {
      show(shot);
      pictures.push_back(render(scene, camera, sheet));
    }
    write_png((folder / "frames.png").string(), contact_sheet(pictures, captions, static_cast<int>(pictures.size())));
  }
  if (progress) progress(0.1);

  // Sewing takes two fifths of the film, the rest is the cloth's.
  std::vector<Shot> shots;
  const int budget = options.most_film_frames;
  if (sewn) {
    const int samples = sewing.frames->samples();
    add_shots(sewing, 0, samples - 1, std::min((samples + 1) / 2, draped ? 2 * budget / 5 : budget), shots);
  }
  if (draped) {
    const int last_frame = cloth.frames->samples() - 1;
    const int still = timing.motion_first >= 0 ? std::min(timing.motion_first, last_frame) : last_frame;
    add_shots(cloth, 0, still, std::min(still / 2 + 1, budget - static_cast<int>(shots.size())), shots);
    const double seconds = (last_frame - still) / timing.fps;
    add_shots(cloth, still, last_frame,
              std::min(static_cast<int>(std::lround(options.film_fps * seconds)), options.most_motion_frames), shots);
  }
  if (!options.film) return;
  Renderer renderer(film);
  const double aspect = static_cast<double>(film.width) / film.height;
  // The garment fills the picture: a body is shown only as far as the cloth reaches, and a little farther.
  const Vec3 margin = Vec3::Constant(0.05);
  const Camera camera = frame_subject(box[0] - margin, box[1] + margin, 25, 8, aspect);
  const auto picture = [&](int k) {
    if (stop && stop()) throw Error(ErrorKind::interrupted, "interrupted while the film was made");
    show(shots[static_cast<std::size_t>(k)]);
    Image image = renderer.render(scene, camera);
    if (progress) progress(0.1 + 0.9 * (k + 1) / static_cast<double>(shots.size()));
    return image;
  };
  write_mp4((folder / "preview.mp4").string(), static_cast<int>(shots.size()), options.film_fps, picture, stop);
}

std::string picture_last_frame(const std::string& directory, const StillOptions& options) {
  require_pictures();
  const std::filesystem::path folder(directory);
  Take cloth, body;
  if (!cloth.open(folder, "cloth") && !cloth.open(folder, "sewing"))
    throw IoError((folder / "cloth.obj").string(), "no such file: this directory holds no run");
  Vec3s x, body_x;
  cloth.frames->read(cloth.frames->samples() - 1, x);
  PreviewScene scene;
  if (body.open(folder, "body")) {
    body.frames->read(std::min(cloth.frames->samples(), body.frames->samples()) - 1, body_x);
    scene.body_triangles = body.obj.triangles;
    scene.body_positions = body_x;
  }
  scene.cloths = cloths_of(cloth, x);
  return still_of(std::move(scene), options);
}

void picture_crossings(const std::string& directory, int frame, const std::string& png) {
  require_pictures();
  const std::filesystem::path folder(directory);
  Take cloth, body;
  if (!cloth.open(folder, "cloth")) throw IoError((folder / "cloth.obj").string(), "no such file");
  const bool dressed = body.open(folder, "body");
  Vec3s x, body_x;
  cloth.frames->read(frame, x);
  if (dressed) body.frames->read(frame, body_x);
  PreviewScene scene;
  scene.cloths = cloths_of(cloth, x);
  scene.body_triangles = body.obj.triangles;
  scene.body_positions = body_x;
  std::array<Vec3, 2> box{Vec3::Constant(1e30), Vec3::Constant(-1e30)};
  grow(box, x);
  grow(box, body_x);
  scene.ground_y_m = box[0].y();
  scene.red_segments = crossing_edges(cloth, x, body, body_x);
  Vec3s ends;
  for (const auto& [a, b] : scene.red_segments) ends.insert(ends.end(), {a, b});
  RenderOptions options;
  options.width = 480;
  options.height = 480;
  write_png(png, three_views(scene, ends.empty() ? x : ends, 0.05, options));
}

}  // namespace toile::internal
