// io/ply_read.cpp: PLY, ascii and binary of both byte orders.
//
// Read: vertex x y z, a uv per vertex (s t, u v, texture_u texture_v, texture_s texture_t) or per corner (a list `texcoord` of the face); of a face
// vertex_indices, and `panel` and `garment`, numbers whose names are comments "panel 0 front".  Everything else is skipped by its declared size.
// Errors name the line of the header or of ascii data, or the byte of binary data.
//
// Easily missed: no memory is allocated for a count of the header that the rest of the file could not hold.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>

#include "core/error.hpp"
#include "io/mesh_formats.hpp"
#include "io/ply_header.hpp"

namespace toile::internal {
namespace {

// The current element, for messages: "vertex 12".
struct Place {
  const PlyElement* element;
  std::size_t item;
  std::string text() const { return printable(element->name) + ' ' + std::to_string(item); }
};

// Reads the numbers after the header one after the other.
class Data {
 public:
  Data(const MeshSource& source, const PlyHeader& header)
      : bytes_(source.bytes), file_(source.file), format_(header.format), at_(header.end), line_(header.lines + 1) {}

  [[noreturn]] void fail(const Place& place, std::string_view expected, std::string_view got) const {
    const bool ascii = format_ == PlyHeader::Format::ascii;
    throw InputError(ascii ? file_ + ':' + std::to_string(line_) : file_,
                     ascii ? place.text() : place.text() + " at byte " + std::to_string(last_), expected, got);
  }

  // Whether the rest of the file can hold so many items of so many numbers; for a list, of its length alone.
  bool can_hold(std::size_t count, const PlyElement& element) const {
    std::size_t least = 0;
    for (const PlyProperty& p : element.properties)
      least += format_ == PlyHeader::Format::ascii ? 2 : bytes_of(p.count.value_or(p.type));
    if (format_ == PlyHeader::Format::ascii) return least == 0 || count <= (bytes_.size() - at_ + 1) / least;
    return least == 0 || count <= (bytes_.size() - at_) / least;
  }
  // The length of a list, checked before memory is allocated for it.
  bool can_hold_list(std::size_t count, PlyNumber type) const {
    const std::size_t left = bytes_.size() - at_;
    return format_ == PlyHeader::Format::ascii ? count <= (left + 1) / 2 : count <= left / bytes_of(type);
  }

  double next(PlyNumber type, const Place& place) {
    last_ = at_;
    return format_ == PlyHeader::Format::ascii ? next_word(type, place) : next_binary(type, place);
  }
  void skip_list(std::size_t count, PlyNumber type, const Place& place) {
    if (format_ != PlyHeader::Format::ascii) {
      at_ += count * bytes_of(type);
      return;
    }
    for (std::size_t k = 0; k < count; ++k) next(type, place);
  }

 private:
  double next_word(PlyNumber type, const Place& place) {
    for (; at_ < bytes_.size(); ++at_) {
      const char c = bytes_[at_];
      if (c == '\n' || (c == '\r' && bytes_.substr(at_, 2) != "\r\n")) ++line_;
      if (c != ' ' && c != '\t' && c != '\n' && c != '\r') break;
    }
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
    std::string_view word = bytes_.substr(at_, end - at_);
    if (word.empty()) fail(place, "a number", "the end of the file");
    at_ = end;
    std::string_view digits = word;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    // A number too small for a double is 0; one too large is refused, as is text that is no number.
    if (error == std::errc::result_out_of_range && stop == digits.data() + digits.size() && too_small(digits)) return 0;
    if (error != std::errc() || stop != digits.data() + digits.size()) fail(place, "a number", quoted(word));
    if (type < PlyNumber::f32 && value != std::floor(value)) fail(place, "a whole number", quoted(word));
    return value;
  }
  static bool too_small(std::string_view digits) {
    const std::size_t exponent = digits.find_first_of("eE");
    if (exponent != std::string_view::npos) return digits.substr(exponent + 1, 1) == "-";
    return digits.find_first_of("123456789") > digits.find('.');
  }

  double next_binary(PlyNumber type, const Place& place) {
    const std::size_t size = bytes_of(type);
    if (bytes_.size() - at_ < size) {
      last_ = at_;
      fail(place, std::to_string(size) + " bytes", std::to_string(bytes_.size() - at_) + " before the end of the file");
    }
    std::array<char, 8> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, size);
    at_ += size;
    static_assert(std::endian::native == std::endian::little);
    if (format_ == PlyHeader::Format::big) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    const auto as = [&](auto value) {
      std::memcpy(&value, raw.data(), sizeof value);
      return static_cast<double>(value);
    };
    switch (type) {
      case PlyNumber::i8:
        return as(std::int8_t{});
      case PlyNumber::u8:
        return as(std::uint8_t{});
      case PlyNumber::i16:
        return as(std::int16_t{});
      case PlyNumber::u16:
        return as(std::uint16_t{});
      case PlyNumber::i32:
        return as(std::int32_t{});
      case PlyNumber::u32:
        return as(std::uint32_t{});
      case PlyNumber::f32:
        return as(float{});
      case PlyNumber::f64:
        break;
    }
    return as(double{});
  }

  std::string_view bytes_;
  std::string file_;
  PlyHeader::Format format_;
  std::size_t at_, last_ = 0;
  int line_;
};

class PlyReader {
 public:
  explicit PlyReader(const MeshSource& source)
      : file_(source.file), header_(parse_ply_header(source)), data_(source, header_) {}

  SurfaceMesh read() {
    bool vertices = false, faces = false;
    for (const PlyElement& element : header_.elements) {
      if (!data_.can_hold(element.count, element))
        throw InputError(file_ + ':' + std::to_string(element.line), "element " + printable(element.name),
                         "no more than the rest of the file can hold", std::to_string(element.count));
      if (element.name == "vertex" && !vertices) {
        vertices = true;
        read_vertices(element);
      } else if (element.name == "face" && !faces) {
        faces = true;
        read_faces(element);
      } else {
        skip(element);
      }
    }
    if (mesh_.positions.empty()) throw InputError(file_, "mesh", "at least one vertex", "none");
    if (mesh_.triangles.empty()) throw InputError(file_, "mesh", "at least one face", "none");
    check_corners();
    settle_uv();
    settle_names();
    return std::move(mesh_);
  }

 private:
  double finite(PlyNumber type, const Place& place) {
    const double value = data_.next(type, place);
    if (!std::isfinite(value)) data_.fail(place, "a finite number", std::isnan(value) ? "not a number" : "infinity");
    return value;
  }
  std::size_t length_of(const PlyProperty& list, const Place& place) {
    const double length = data_.next(*list.count, place);
    if (!(length >= 0))
      data_.fail(place, "a list of at least 0 numbers", std::to_string(static_cast<long long>(length)));
    if (length > 4e9 || !data_.can_hold_list(static_cast<std::size_t>(length), list.type))
      data_.fail(place, "a list that the rest of the file can hold",
                 length > 4e9 ? "more" : std::to_string(static_cast<std::size_t>(length)) + " numbers");
    return static_cast<std::size_t>(length);
  }
  void pass_over(const PlyProperty& property, const Place& place) {
    if (property.count)
      data_.skip_list(length_of(property, place), property.type, place);
    else
      data_.next(property.type, place);
  }

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;  // no bytes belong to it
    for (std::size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) pass_over(property, Place{&element, i});
  }

  void read_vertices(const PlyElement& element) {
    if (element.count > mesh_vertex_limit)
      throw InputError(file_ + ':' + std::to_string(element.line), "element vertex",
                       "at most " + std::to_string(mesh_vertex_limit) + " vertices", std::to_string(element.count));
    std::array<Index, 3> axis{};
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
      axis[k] = element.find({names[k]});
      if (axis[k] < 0 || element.properties[at(axis[k])].count)
        throw InputError(file_ + ':' + std::to_string(element.line), "element vertex",
                         "a property \"" + std::string(names[k]) + '"', "none");
    }
    const Index u = element.find({"s", "u", "texture_u", "texture_s"});
    const Index v = element.find({"t", "v", "texture_v", "texture_t"});
    has_uv_ = u >= 0 && v >= 0 && !element.properties[at(u)].count && !element.properties[at(v)].count;
    mesh_.positions.reserve(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3 x = Vec3::Zero();
      Vec2 uv = Vec2::Zero();
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        const auto here = static_cast<Index>(k);
        const auto axis_here = std::find(axis.begin(), axis.end(), here);
        if (axis_here != axis.end())
          x[axis_here - axis.begin()] = finite(property.type, Place{&element, i});
        else if (has_uv_ && (here == u || here == v))
          uv[here == u ? 0 : 1] = finite(property.type, Place{&element, i});
        else
          pass_over(property, Place{&element, i});
      }
      mesh_.positions.push_back(x);
      if (has_uv_) mesh_.texcoords.push_back(uv);
    }
  }

  void read_faces(const PlyElement& element) {
    const Index indices = element.find({"vertex_indices", "vertex_index"});
    if (indices < 0 || !element.properties[at(indices)].count)
      throw InputError(file_ + ':' + std::to_string(element.line), "element face", "a list \"vertex_indices\"", "none");
    const auto scalar = [&](std::string_view name) {
      const Index k = element.find({name});
      return k >= 0 && !element.properties[at(k)].count ? k : -1;
    };
    const Index texcoord = element.find({"texcoord"}), panel = scalar("panel"), garment = scalar("garment");
    const bool corners_have_uv = texcoord >= 0 && element.properties[at(texcoord)].count.has_value();
    panel_.known = panel >= 0;
    garment_.known = garment >= 0;
    std::vector<double> corners, uv;
    for (std::size_t i = 0; i < element.count; ++i) {
      const Place place{&element, i};
      Index of_panel = 0, of_garment = 0;
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        const auto here = static_cast<Index>(k);
        if (here == indices) {
          read_list(property, place, corners);
        } else if (corners_have_uv && here == texcoord) {
          read_list(property, place, uv);
        } else if (here == panel || here == garment) {
          (here == panel ? of_panel : of_garment) = number_of(property, place);
        } else {
          pass_over(property, place);
        }
      }
      add_face(corners, uv, of_panel, of_garment, place);
    }
  }

  void read_list(const PlyProperty& list, const Place& place, std::vector<double>& values) {
    values.clear();
    const std::size_t length = length_of(list, place);
    for (std::size_t k = 0; k < length; ++k) values.push_back(finite(list.type, place));
  }
  Index number_of(const PlyProperty& property, const Place& place) {
    const double value = finite(property.type, place);
    if (!(value >= 0 && value <= 1e9) || value != std::floor(value))
      data_.fail(place, "a whole number from 0 for " + printable(property.name), std::to_string(value));
    return static_cast<Index>(value);
  }

  void add_face(const std::vector<double>& corners, const std::vector<double>& uv, Index panel, Index garment,
                const Place& place) {
    if (corners.size() < 3) data_.fail(place, "at least 3 corners", std::to_string(corners.size()));
    if (!uv.empty() && uv.size() != 2 * corners.size())
      data_.fail(place, std::to_string(2 * corners.size()) + " numbers in texcoord", std::to_string(uv.size()));
    if (mesh_.triangles.size() + corners.size() - 2 > mesh_triangle_limit)
      data_.fail(place, "at most " + std::to_string(mesh_triangle_limit) + " triangles", "more");
    for (const double corner : corners)
      if (!(corner >= 0 && corner < static_cast<double>(mesh_vertex_limit)))
        data_.fail(place, "corners from 0", std::to_string(static_cast<long long>(corner)));
    const auto first_uv = static_cast<Index>(corner_uv_.size());
    for (std::size_t k = 0; k + 1 < uv.size(); k += 2) corner_uv_.emplace_back(uv[k], uv[k + 1]);
    for (std::size_t c = 2; c < corners.size(); ++c) {
      mesh_.triangles.push_back(
          {static_cast<Index>(corners[0]), static_cast<Index>(corners[c - 1]), static_cast<Index>(corners[c])});
      const auto k = static_cast<Index>(c);
      mesh_.texcoord.push_back(uv.empty() ? std::array<Index, 3>{-1, -1, -1}
                                          : std::array<Index, 3>{first_uv, first_uv + k - 1, first_uv + k});
      mesh_.group.push_back(panel_.of(panel));
      mesh_.object.push_back(garment_.of(garment));
      face_.push_back(place_number_);
    }
    ++place_number_;
  }

  void check_corners() const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (const Index i : mesh_.triangles[t])
        if (at(i) >= mesh_.positions.size())
          throw InputError(file_, "face " + std::to_string(face_[t]),
                           "corners in 0.." + std::to_string(mesh_.positions.size() - 1), std::to_string(i));
  }

  // uv of corners before uv of vertices: a file that has both means the former.
  void settle_uv() {
    if (!corner_uv_.empty()) {
      mesh_.texcoords = std::move(corner_uv_);
    } else if (has_uv_) {
      mesh_.texcoord = mesh_.triangles;
    } else {
      mesh_.texcoord = {};
    }
  }
  void settle_names() {
    const auto names = [&](const Numbers& numbers, std::string_view what) {
      if (!numbers.known) return std::vector<std::string>{""};
      std::vector<std::string> found;
      const auto told = header_.names.find(what);
      for (const Index number : numbers.used) {
        const bool named = told != header_.names.end() && told->second.contains(number);
        found.push_back(named ? told->second.at(number) : std::string(what) + ' ' + std::to_string(number));
      }
      return found;
    };
    mesh_.group_names = names(panel_, "panel");
    mesh_.object_names = names(garment_, "garment");
  }

  // Numbers of panels or garments, in order of appearance.
  struct Numbers {
    bool known = false;
    std::map<Index, Index> place;
    std::vector<Index> used;
    Index of(Index number) {
      const auto [at_number, is_new] = place.try_emplace(number, static_cast<Index>(used.size()));
      if (is_new) used.push_back(number);
      return at_number->second;
    }
  };

  std::string file_;
  PlyHeader header_;
  Data data_;
  SurfaceMesh mesh_;
  bool has_uv_ = false;
  Vec2s corner_uv_;
  Numbers panel_, garment_;
  std::vector<std::size_t> face_;  // [triangle] of the file
  std::size_t place_number_ = 0;
};

}  // namespace

MeshReader ply_reader() {
  return {"PLY",
          {".ply"},
          [](std::string_view bytes) { return bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 4) == "ply\r"; },
          [](const MeshSource& source) { return PlyReader(source).read(); },
          nullptr};
}

}  // namespace toile::internal
