// io/usda_write.cpp: USD as text: a mesh per garment whose points move, its panels as subsets with a material each.
//
//   /run (Xform) / GARMENT (Mesh) / PANEL (GeomSubset), /run/materials/PANEL
//
// Metres, y up; a time code is a frame.  Velocities are metres per second, from a frame to the next, and of the last from the one before.  The
// drawing is primvars:st, per corner, in metres as in the pattern.
//
// Easily missed: programs show subsets only where they bind a material, so each panel has one of its own.
#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "io/file.hpp"
#include "io/mesh_writer.hpp"
#include "io/sequence_writer.hpp"

namespace toile::internal {
namespace {

// "shirt_front_2": letters, digits and "_", not beginning with a digit, and no name of `taken`, to which it is added.
std::string identifier(std::string_view name, std::set<std::string>& taken) {
  std::string text;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    text += letter || (c >= '0' && c <= '9') ? c : '_';
  }
  if (text.empty() || (text[0] >= '0' && text[0] <= '9')) text = '_' + text;
  std::string unique = text;
  for (int k = 2; !taken.insert(unique).second; ++k) unique = text + '_' + std::to_string(k);
  return unique;
}

std::string usd_string(std::string_view name) {
  std::string text = "\"";
  for (const char c : name_on_one_line(name)) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

void add_number(std::string& text, float number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number == 0 ? 0.0F : number).ptr);
}

void add_tuple(std::string& text, const Vec3& v) {
  text += '(';
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (k > 0) text += ", ";
    add_number(text, static_cast<float>(v[k]));
  }
  text += ')';
}

template <class List, class F>
void add_list(std::string& text, const List& list, const F& add) {
  text += '[';
  bool first = true;
  for (const auto& item : list) {
    if (!first) text += ", ";
    first = false;
    add(item);
  }
  text += ']';
}

void add_indices(std::string& text, const std::vector<Index>& indices) {
  add_list(text, indices, [&](Index i) { text += std::to_string(i); });
}

struct Subset {
  std::string identifier, name, material;
  std::vector<Index> faces;
};

// One garment, or a surface without garments.
struct UsdMesh {
  std::string identifier, name;
  std::vector<Index> vertices;  // of the surface
  std::vector<Triangle> triangles;
  std::vector<Index> texcoord;  // [corner]; empty: none
  std::vector<Subset> subsets;
};

std::vector<UsdMesh> meshes_of(const SurfaceSequence& surface, std::set<std::string>& taken,
                               std::set<std::string>& materials) {
  const SurfaceMesh& mesh = *surface.mesh;
  std::vector<UsdMesh> meshes;
  std::vector<Index> local(mesh.positions.size(), -1);
  Index object = -2;
  std::set<std::string> taken_inside;
  for (const MeshPiece& piece : pieces_of(mesh)) {
    if (piece.object != object) {
      object = piece.object;
      const std::string name = object >= 0 ? mesh.object_names[at(object)] : std::string();
      meshes.push_back(
          {identifier(name.empty() ? surface.name : name, taken), name.empty() ? surface.name : name, {}, {}, {}, {}});
      std::fill(local.begin(), local.end(), -1);
      taken_inside.clear();
    }
    UsdMesh& into = meshes.back();
    Subset subset;
    for (const std::size_t t : piece.triangles) {
      subset.faces.push_back(static_cast<Index>(into.triangles.size()));
      Triangle corners = mesh.triangles[t];
      for (Index& v : corners) {
        if (local[at(v)] < 0) {
          local[at(v)] = static_cast<Index>(into.vertices.size());
          into.vertices.push_back(v);
        }
        v = local[at(v)];
      }
      into.triangles.push_back(corners);
      if (!mesh.texcoord.empty())
        for (const Index uv : mesh.texcoord[t]) into.texcoord.push_back(uv);
    }
    if (piece.group < 0 || mesh.group_names[at(piece.group)].empty()) continue;
    subset.name = mesh.group_names[at(piece.group)];
    subset.identifier = identifier(subset.name, taken_inside);
    subset.material = identifier(subset.name, materials);
    into.subsets.push_back(std::move(subset));
  }
  for (UsdMesh& one : meshes)  // all or none
    if (std::find(one.texcoord.begin(), one.texcoord.end(), -1) != one.texcoord.end()) one.texcoord.clear();
  return meshes;
}

class UsdText {
 public:
  UsdText(const std::string& path, const Sequence& sequence) : path_(path), sequence_(sequence), file_(path) {}

  bool write() {
    std::set<std::string> taken{"materials"};
    const int last = sequence_.frames - 1;
    text_ = "#usda 1.0\n(\n    defaultPrim = \"run\"\n    doc = \"made by Toile\"\n    endTimeCode = " +
            std::to_string(last) + "\n    framesPerSecond = ";
    add_number(text_, static_cast<float>(sequence_.fps));
    text_ += "\n    metersPerUnit = 1\n    startTimeCode = 0\n    timeCodesPerSecond = ";
    add_number(text_, static_cast<float>(sequence_.fps));
    text_ += "\n    upAxis = \"Y\"\n)\n\ndef Xform \"run\"\n{\n";
    for (const SurfaceSequence& surface : sequence_.surfaces) {
      check_writable(path_, *surface.mesh);
      for (const UsdMesh& mesh : meshes_of(surface, taken, materials_))
        if (!write_mesh(surface, mesh)) return false;
    }
    write_materials();
    text_ += "}\n";
    flush();
    file_.commit();
    return true;
  }

 private:
  void flush() {
    file_.write(text_);
    text_.clear();
  }

  // `add` puts the value of a frame behind its time code.  False if it was stopped.
  template <class F>
  bool add_samples(std::string_view type, std::string_view name, const std::vector<char>& written, const F& add) {
    text_ += "        " + std::string(type) + ' ' + std::string(name) + ".timeSamples = {\n";
    for (int frame = 0; frame < sequence_.frames; ++frame) {
      if (written[static_cast<std::size_t>(frame)] == 0) continue;
      if (sequence_.goes_on && !sequence_.goes_on()) return false;
      text_ += "            " + std::to_string(frame) + ": ";
      add(frame);
      text_ += ",\n";
      flush();
    }
    text_ += "        }\n";
    return true;
  }

  // [frame] 0 where the surface stands still around it, with the frame before and two after: readers go straight from sample to sample.
  std::vector<char> samples_of(const SurfaceSequence& surface) {
    const auto frames = static_cast<std::size_t>(sequence_.frames);
    std::vector<char> moves(frames + 2, 0);  // from the frame before
    Vec3s before = positions(surface, 0);
    for (std::size_t f = 1; f < frames; ++f) {
      Vec3s x = positions(surface, static_cast<int>(f));
      moves[f] = x != before ? 1 : 0;
      before = std::move(x);
    }
    std::vector<char> written(frames, 1);
    for (std::size_t f = 1; f < frames; ++f) written[f] = (moves[f] | moves[f + 1] | moves[f + 2]) != 0 ? 1 : 0;
    return written;
  }

  Vec3s positions(const SurfaceSequence& surface, int frame) {
    Vec3s x;
    read_frame(path_, surface, frame, x);
    return x;
  }

  bool write_mesh(const SurfaceSequence& surface, const UsdMesh& mesh) {
    text_ += "    def Mesh \"" + mesh.identifier + "\" (\n        displayName = " + usd_string(mesh.name) +
             "\n    )\n    {\n";
    text_ += "        uniform bool doubleSided = 1\n        uniform token subdivisionScheme = \"none\"\n";
    text_ += "        int[] faceVertexCounts = ";
    add_list(text_, mesh.triangles, [&](const Triangle&) { text_ += '3'; });
    text_ += "\n        int[] faceVertexIndices = ";
    std::vector<Index> corners;
    for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    add_indices(text_, corners);
    text_ += '\n';
    const auto of_mesh = [&](const Vec3s& all) {
      Vec3s own;
      for (const Index v : mesh.vertices) own.push_back(all[at(v)]);
      return own;
    };
    const auto add_tuples = [&](const Vec3s& values) {
      add_list(text_, values, [&](const Vec3& v) { add_tuple(text_, v); });
    };
    const int last = sequence_.frames - 1;
    const std::vector<char> written = samples_of(surface);
    text_ += "        normal3f[] normals (\n            interpolation = \"vertex\"\n        )\n";
    const bool whole =
        add_samples("float3[]", "extent", written,
                    [&](int frame) {
                      Eigen::AlignedBox3d box;
                      for (const Vec3& p : of_mesh(positions(surface, frame))) box.extend(p);
                      add_tuples({box.min(), box.max()});
                    }) &&
        add_samples("point3f[]", "points", written,
                    [&](int frame) { add_tuples(of_mesh(positions(surface, frame))); }) &&
        add_samples("normal3f[]", "normals", written,
                    [&](int frame) { add_tuples(of_mesh(normals_of(*surface.mesh, positions(surface, frame)))); }) &&
        (last == 0 || add_samples("vector3f[]", "velocities", written, [&](int frame) {
           const int from = std::min(frame, last - 1);
           const Vec3s before = of_mesh(positions(surface, from));
           Vec3s v = of_mesh(positions(surface, from + 1));
           for (std::size_t i = 0; i < v.size(); ++i) v[i] = (v[i] - before[i]) * sequence_.fps;
           add_tuples(v);
         }));
    if (!whole) return false;
    write_drawing(surface, mesh);
    write_subsets(mesh);
    text_ += "    }\n\n";
    flush();
    return true;
  }

  void write_drawing(const SurfaceSequence& surface, const UsdMesh& mesh) {
    if (mesh.texcoord.empty()) return;
    std::vector<Index> used(mesh.texcoord), local;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const Index uv : mesh.texcoord)
      local.push_back(static_cast<Index>(std::lower_bound(used.begin(), used.end(), uv) - used.begin()));
    text_ += "        texCoord2f[] primvars:st = ";
    add_list(text_, used, [&](Index uv) {
      const Vec2& st = surface.mesh->texcoords[at(uv)];
      text_ += '(';
      add_number(text_, static_cast<float>(st.x()));
      text_ += ", ";
      add_number(text_, static_cast<float>(st.y()));
      text_ += ')';
    });
    text_ += " (\n            interpolation = \"faceVarying\"\n        )\n        int[] primvars:st:indices = ";
    add_indices(text_, local);
    text_ += '\n';
  }

  void write_subsets(const UsdMesh& mesh) {
    if (mesh.subsets.empty()) return;
    text_ += "        uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"\n";
    for (const Subset& subset : mesh.subsets) {
      text_ += "\n        def GeomSubset \"" + subset.identifier +
               "\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n            displayName = " +
               usd_string(subset.name) +
               "\n        )\n        {\n            uniform token elementType = \"face\"\n"
               "            uniform token familyName = \"materialBind\"\n            int[] indices = ";
      add_indices(text_, subset.faces);
      text_ += "\n            rel material:binding = </run/materials/" + subset.material + ">\n        }\n";
    }
  }

  // Colours that tell neighbours apart: hues a golden angle apart.
  void write_materials() {
    if (materials_.empty()) return;
    text_ += "    def Scope \"materials\"\n    {\n";
    int number = 0;
    for (const std::string& name : materials_) {
      constexpr double golden = 0.381966011250105;
      const double hue = 3 * std::fmod(golden * number++, 1.0);
      const auto share = [&](double of) {  // of red, green or blue
        const double away = std::abs(hue - of);
        return 0.35 + 0.4 * std::max(0.0, 1 - std::min(away, 3 - away));
      };
      const Vec3 colour(share(0), share(1), share(2));
      const std::string place = "</run/materials/" + name + "/surface.outputs:surface>";
      text_ += "        def Material \"" + name +
               "\"\n        {\n            token outputs:surface.connect = " + place +
               "\n\n            def Shader \"surface\"\n            {\n"
               "                uniform token info:id = \"UsdPreviewSurface\"\n                color3f "
               "inputs:diffuseColor = ";
      add_tuple(text_, colour);
      text_ +=
          "\n                float inputs:roughness = 0.8\n                token outputs:surface\n            }\n      "
          "  }\n";
    }
    text_ += "    }\n";
  }

  const std::string& path_;
  const Sequence& sequence_;
  AtomicFile file_;
  std::string text_;
  std::set<std::string> materials_;
};

bool write_usda(const std::string& path, const Sequence& sequence) { return UsdText(path, sequence).write(); }

}  // namespace

SequenceWriter usda_sequence_writer() { return {"usda", ".usda", true, write_usda}; }

}  // namespace toile::internal
