#include "sim/cloths.hpp"

#include "core/error.hpp"
#include "sim/check_garment.hpp"

namespace toile::internal {
namespace {

// The place of errors of a cloth without a file of its own.
std::string path_of_kind(const SceneCloth& cloth, std::string_view path) {
  std::string whole(path);
  std::visit(
      [&]<class Kind>(const Kind&) {
        if constexpr (requires { Kind::key; }) whole.append("/").append(Kind::key);
      },
      cloth.kind);
  return whole;
}

}  // namespace

bool SceneCloth::is_sewn() const {
  return std::visit([]<class Kind>(const Kind&) { return Kind::sewn; }, kind);
}

bool SceneCloth::has_own_edge() const {
  return std::visit(
      [](const auto& own) {
        return requires { own.edge_m; };
      },
      kind);
}

double SceneCloth::edge_m() const {
  return std::visit(
      [&](const auto& own) {
        if constexpr (requires { own.edge_m; })
          return own.edge_m;
        else
          return resolution_m;
      },
      kind);
}

void SceneCloth::set_edge_m(double edge_m) {
  resolution_m = edge_m;
  std::visit(
      [&](auto& own) {
        if constexpr (requires { own.edge_m; }) own.edge_m = edge_m;
        if constexpr (requires { own.vertices; }) own.vertices.reset();
      },
      kind);
}

std::string_view SceneCloth::path() const {
  return std::visit(
      [](const auto& own) -> std::string_view {
        if constexpr (requires { own.path; })
          return own.path;
        else
          return {};
      },
      kind);
}

MeshedCloth mesh_cloth(const SceneCloth& cloth, std::string_view path, const TextSource& read) {
  const std::string_view file = cloth.path();
  const std::string where = printable(file.empty() ? cloth.name : file);
  try {
    MeshedCloth meshed = std::visit([&](const auto& kind) { return load(kind, cloth, read); }, cloth.kind);
    check_garment(where, meshed.garment);
    return meshed;
  } catch (const InputError& error) {
    if (!file.empty()) throw error.within(where);
    throw error.within(where).of(path_of_kind(cloth, path));
  }
}

ClothCost cost_of(const SceneCloth& cloth, const TextSource& read) {
  return std::visit([&](const auto& kind) { return cost(kind, cloth, read); }, cloth.kind);
}

}  // namespace toile::internal
