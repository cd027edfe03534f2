#include "io/obj.hpp"

#include "io/file.hpp"
#include "io/mesh_formats.hpp"

#include <charconv>

namespace toile::internal {
namespace {

// Buffers the text for the file.
class ObjText {
 public:
  explicit ObjText(AtomicFile& file) : file_(file) {}

  void word(std::string_view text) { text_ += text; }
  // "%.9g" of the float, in every locale.
  void number(double value) {
    char digits[32];
    const auto end =
        std::to_chars(digits, digits + sizeof digits, static_cast<float>(value), std::chars_format::general, 9).ptr;
    text_.append(digits, end);
  }
  void index(Index from_zero) { text_ += std::to_string(from_zero + 1); }
  // It cannot go on in the next line either.
  void name(std::string_view text) {
    text_ += name_on_one_line(text);
    if (!text.empty() && text_.back() == '\\') text_.back() = '_';
  }
  void end_line() {
    text_ += '\n';
    if (text_.size() > (std::size_t{1} << 20)) flush();
  }
  void flush() {
    file_.write(text_);
    text_.clear();
  }

 private:
  AtomicFile& file_;
  std::string text_;
};

}  // namespace

void write_obj(const std::string& path, const SurfaceMesh& mesh) {
  check_writable(path, mesh);
  const std::vector<MeshPiece> pieces = pieces_of(mesh);
  AtomicFile file(path);
  ObjText text(file);

  const auto write_object = [&](const MeshPiece& piece) {
    text.word("o ");
    text.name(mesh.object_names[at(piece.object)]);
    text.end_line();
  };
  // Programs that read one object per `o` expect its vertices after it.
  const bool one_object = !pieces.empty() && pieces.front().object == pieces.back().object;
  if (one_object && !mesh.object.empty()) write_object(pieces.front());

  for (const Vec3& x : mesh.positions) {
    text.word("v");
    for (const double coordinate : x) {
      text.word(" ");
      text.number(coordinate);
    }
    text.end_line();
  }
  for (const Vec2& uv : mesh.texcoords) {
    text.word("vt");
    for (const double coordinate : uv) {
      text.word(" ");
      text.number(coordinate);
    }
    text.end_line();
  }
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const MeshPiece& piece = pieces[p];
    if (!one_object && (p == 0 || piece.object != pieces[p - 1].object)) write_object(piece);
    if (!mesh.group.empty()) {
      text.word("g ");
      text.name(mesh.group_names[at(piece.group)]);
      text.end_line();
    }
    for (const std::size_t t : piece.triangles) {
      text.word("f");
      for (std::size_t corner = 0; corner < 3; ++corner) {
        text.word(" ");
        text.index(mesh.triangles[t][corner]);
        if (!mesh.texcoord.empty() && mesh.texcoord[t][corner] >= 0) {
          text.word("/");
          text.index(mesh.texcoord[t][corner]);
        }
      }
      text.end_line();
    }
  }
  text.flush();
  file.commit();
}

MeshWriter obj_writer() { return {"obj", ".obj", write_obj}; }

}  // namespace toile::internal
