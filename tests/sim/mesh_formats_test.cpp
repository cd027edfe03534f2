// Cloth, bodies and solids from files of every format, and runs as files of every format.
#include "body/solid_shapes.hpp"
#include "core/error.hpp"
#include "io/mesh_file.hpp"
#include "io/mesh_writer.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/scratch.hpp"
#include "sim/export_run.hpp"
#include "sim/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace toile::internal {
namespace {

// A tube of two panels around the y axis, drawn in metres, the two seams with a vt for each panel.
SurfaceMesh sleeve(bool drawn) {
  constexpr int around = 12, up = 5;
  constexpr double radius = 0.13, edge = 0.06;
  SurfaceMesh mesh;
  const std::array<std::array<double, 2>, 12> circle{{{1, 0},
                                                      {0.866025404, 0.5},
                                                      {0.5, 0.866025404},
                                                      {0, 1},
                                                      {-0.5, 0.866025404},
                                                      {-0.866025404, 0.5},
                                                      {-1, 0},
                                                      {-0.866025404, -0.5},
                                                      {-0.5, -0.866025404},
                                                      {0, -1},
                                                      {0.5, -0.866025404},
                                                      {0.866025404, -0.5}}};
  for (int j = 0; j <= up; ++j)
    for (const auto& c : circle) mesh.positions.emplace_back(radius * c[0], 0.3 + edge * j, -radius * c[1]);
  const double width = 2 * radius * 0.258819045;
  for (int panel = 0; panel < 2; ++panel)
    for (int j = 0; j <= up; ++j)
      for (int i = 0; i <= around / 2; ++i) mesh.texcoords.emplace_back(panel + width * i, edge * j);
  for (int panel = 0; panel < 2; ++panel)
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < around / 2; ++i) {
        const auto vertex = [&](int a, int b) {
          return static_cast<Index>((j + b) * around + (panel * around / 2 + i + a) % around);
        };
        const auto vt = [&](int a, int b) {
          return static_cast<Index>(panel * (up + 1) * (around / 2 + 1) + (j + b) * (around / 2 + 1) + i + a);
        };
        for (const auto& [p, q, r] : {std::array{std::array{0, 0}, std::array{1, 0}, std::array{1, 1}},
                                      std::array{std::array{0, 0}, std::array{1, 1}, std::array{0, 1}}}) {
          mesh.triangles.push_back({vertex(p[0], p[1]), vertex(q[0], q[1]), vertex(r[0], r[1])});
          mesh.texcoord.push_back({vt(p[0], p[1]), vt(q[0], q[1]), vt(r[0], r[1])});
          mesh.group.push_back(panel);
          mesh.object.push_back(0);
        }
      }
  mesh.group_names = {"front", "back"};
  mesh.object_names = {"sleeve"};
  if (!drawn) {
    mesh.texcoord = {};
    mesh.texcoords = {};
  }
  return mesh;
}

void put(const Scratch& scratch, const std::string& name, const SurfaceMesh& mesh) {
  mesh_writer_for(name)->write(scratch / name, mesh);
}

Report run_text(const Scratch& scratch, const std::string& out, const std::string& text) {
  const std::string path = scratch.put(out + ".json", text);
  RunOptions options;
  options.directory = scratch / out;
  return simulate(parse_scene(text, path), options);
}

Vec3s last_frame(const std::string& pc2) {
  Pc2Reader reader(pc2);
  Vec3s x;
  reader.read(reader.samples() - 1, x);
  return x;
}

std::string pinned(const Scratch& scratch, const std::string& file) {
  return R"({"cloth": [{"mesh": ")" + (scratch / file) +
         R"(", "fabric": "silk", "panels": {"back": {"fabric": "denim"}}, "pins": [{"in_box_m": [[-1, 0.599, -1], [1, 0.601, 1]]}]}], "time": {"seconds": 0.4}})";
}

// Of the same cloth, as one file of each format, the seams of its drawing split where the format wants it.
TEST(MeshFormats, TheSameClothFromEveryFormatIsTheSameRun) {
  const Scratch scratch;
  std::vector<Vec3s> last;
  for (const char* file : {"g.obj", "g.ply", "g.glb"}) {
    put(scratch, file, sleeve(true));
    const std::string out = std::string(file).append("_out");
    const Report report = run_text(scratch, out, pinned(scratch, file));
    EXPECT_EQ(report.vertices, 72) << file;
    EXPECT_EQ(report.panels, 2) << file;
    const bool splits = std::string(file) != "g.obj";
    ASSERT_EQ(report.warnings.size(), splits ? 1U : 0U) << file;
    if (splits) {
      EXPECT_NE(report.warnings[0].find("along a seam"), std::string::npos);
    }
    last.push_back(last_frame(scratch / (out + "/cloth.pc2")));

    const SurfaceMesh cloth = load_obj(scratch / (out + "/cloth.obj"));
    EXPECT_EQ(cloth.group_names, (std::vector<std::string>{"front", "back"})) << file;
    ASSERT_EQ(cloth.texcoord.size(), 120U);
    for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
      const auto drawn = [&](const SurfaceMesh& mesh, std::size_t k) {
        return mesh.texcoords[at(mesh.texcoord[t][k])];
      };
      for (std::size_t k = 1; k < 3; ++k)
        EXPECT_LT((drawn(cloth, k) - drawn(cloth, 0) - (drawn(sleeve(true), k) - drawn(sleeve(true), 0))).norm(), 1e-6)
            << file;
    }
  }
  ASSERT_EQ(last[0].size(), last[1].size());
  for (std::size_t i = 0; i < last[0].size(); ++i)
    EXPECT_LT((last[0][i] - last[1][i]).norm(), 1e-3) << "PLY keeps the order of the vertices";
  const auto apart = [&](const Vec3s& a, const Vec3s& b) {
    // glTF has the vertices panel by panel, so another order: nearest is enough for what hangs from its rim.
    double most = 0;
    for (const Vec3& x : a) {
      double least = 1;
      for (const Vec3& y : b) least = std::min(least, (x - y).norm());
      most = std::max(most, least);
    }
    return most;
  };
  EXPECT_LT(apart(last[0], last[2]), 2e-3);
}

TEST(MeshFormats, APlyWithoutDrawingIsAtRestAsItStarts) {
  const Scratch scratch;
  put(scratch, "g.ply", sleeve(false));
  const Report report = run_text(scratch, "out", pinned(scratch, "g.ply"));
  EXPECT_EQ(report.vertices, 72);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("not every face has vt"), std::string::npos);
}

// A body as glTF, its vertices split for the uv of each face, and the cloth on it as glTF.
TEST(MeshFormats, AGltfClothIsWornOnAGltfBodyBesideAPlySolid) {
  const Scratch scratch;
  put(scratch, "g.glb", sleeve(true));
  SurfaceMesh arm;
  const SolidMesh cylinder = rounded_cylinder(0.11, 0.7, Vec3(0, 0.7, 0));
  for (const Triangle& t : cylinder.triangles) {
    Triangle own{};
    for (std::size_t k = 0; k < 3; ++k) {
      own[k] = static_cast<Index>(arm.positions.size());
      arm.positions.push_back(cylinder.positions[at(t[k])]);
    }
    arm.triangles.push_back(own);
  }
  put(scratch, "arm.glb", arm);
  SurfaceMesh ground;
  const SolidMesh slab = block(Vec3(2, 0.1, 2));
  ground.positions = slab.positions;
  ground.triangles = slab.triangles;
  put(scratch, "ground.ply", ground);
  const Report report =
      run_text(scratch, "out",
               R"({"cloth": [{"mesh": ")" + (scratch / "g.glb") + R"("}], "body": {"mesh": ")" + (scratch / "arm.glb") +
                   R"("}, "solids": [{"mesh": ")" + (scratch / "ground.ply") +
                   R"(", "placement": {"translation_m": [0, -0.06, 0]}}], "time": {"seconds": 0.5}})");
  EXPECT_EQ(report.body_vertices, static_cast<int>(cylinder.positions.size() + slab.positions.size()));
  EXPECT_EQ(report.audit.cloth_body_edges.max, 0);
  EXPECT_EQ(report.audit.cloth_cloth_edges.max, 0);
  for (const Vec3& x : last_frame(scratch / "out/cloth.pc2")) EXPECT_GT(x.y(), -0.02);

  // And out again: panels, materials by their fabrics, the body.
  ExportOptions options;
  options.out = scratch / "last.glb";
  const Exported exported = export_run(scratch / "out", options);
  EXPECT_EQ(exported.files, std::vector<std::string>{scratch / "last.glb"});
  const SurfaceMesh cloth = load_mesh(scratch / "last.glb");
  EXPECT_EQ(cloth.group_names, (std::vector<std::string>{"front", "back"}));
  EXPECT_EQ(cloth.object_names, std::vector<std::string>{"g"});
  EXPECT_EQ(cloth.group_material, (std::vector<std::string>{"cotton", "cotton"}));
  EXPECT_EQ(cloth.triangles.size(), 120U);
  const Vec3s last = last_frame(scratch / "out/cloth.pc2");
  for (const Vec3& x : cloth.positions) EXPECT_EQ(std::count(last.begin(), last.end(), x), 1) << "positions to the bit";
  options.of = "body";
  options.out = scratch / "body.ply";
  options.frame = 0;
  export_run(scratch / "out", options);
  EXPECT_EQ(load_mesh(scratch / "body.ply").positions.size(), static_cast<std::size_t>(report.body_vertices));
}

TEST(ExportRun, WritesOneFrameOrAllAndRefusesWhatCannotBeMeant) {
  const Scratch scratch;
  run_text(scratch, "out",
           R"({"cloth": [{"grid": {"width_m": 0.2, "height_m": 0.2, "edge_m": 0.1}}], "time": {"seconds": 0.1}})");
  const std::string folder = scratch / "out";
  Pc2Reader reader(scratch / "out/cloth.pc2");
  ExportOptions options;
  options.to = "ply";
  options.all = true;
  options.out = scratch / "frames";
  const Exported all = export_run(folder, options);
  ASSERT_EQ(all.files.size(), static_cast<std::size_t>(reader.samples()));
  EXPECT_EQ(all.files[1], scratch / "frames/cloth_0001.ply");
  Vec3s x;
  for (int frame = 0; frame < reader.samples(); ++frame) {
    reader.read(frame, x);
    const SurfaceMesh mesh = load_mesh(all.files[at(frame)]);
    for (const Vec3& p : mesh.positions) EXPECT_EQ(std::count(x.begin(), x.end(), p), 1) << frame;
  }
  EXPECT_NO_THROW(export_run(folder, options)) << "over itself";
  scratch.put("frames/cloth_0999.ply", "");
  EXPECT_NE(message_of<IoError>([&] { export_run(folder, options); }).find("would stand among the frames"),
            std::string::npos);

  const auto complaint = [&](auto&& change) {
    ExportOptions wrong;
    wrong.to = "ply";
    wrong.out = scratch / "a.ply";
    change(wrong);
    try {
      export_run(folder, wrong);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(complaint([](ExportOptions&) {}), "none");
  EXPECT_NE(complaint([](ExportOptions& o) { o.frame = 99; }).find("frame: expected 0 to "), std::string::npos);
  EXPECT_NE(
      complaint([](ExportOptions& o) { o.to = "fbx"; }).find("expected obj, ply, gltf, pc2, mdd or usda, got fbx"),
      std::string::npos);
  EXPECT_NE(complaint([](ExportOptions& o) { o.to = "gltf"; }).find("expected a file that ends in .glb"),
            std::string::npos);
  EXPECT_NE(complaint([](ExportOptions& o) { o.of = "body"; }).find("body.obj"), std::string::npos) << "there is none";
  EXPECT_NE(complaint([](ExportOptions& o) { o.of = "hat"; }).find("expected cloth, body or both"), std::string::npos);
  EXPECT_NE(complaint([&](ExportOptions& o) {
              o.to = "obj";
              o.out = scratch / "out/../out/cloth.obj";
            }).find("is a file of the run"),
            std::string::npos);
}

}  // namespace
}  // namespace toile::internal
