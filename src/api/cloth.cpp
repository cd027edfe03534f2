#include "toile/cloth.hpp"

#include "api/parts.hpp"
#include "sim/check_garment.hpp"

#include <algorithm>
#include <filesystem>

namespace toile {
namespace {

// The cloth's settings of this panel.
internal::ScenePanel& panel_of(internal::SceneCloth& cloth, std::string_view name) {
  const auto known = std::find_if(cloth.panels.begin(), cloth.panels.end(),
                                  [&](const internal::ScenePanel& panel) { return panel.name == name; });
  if (known != cloth.panels.end()) return *known;
  internal::ScenePanel& panel = cloth.panels.emplace_back();
  panel.name = name;
  return panel;
}

}  // namespace

Cloth::Cloth(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Cloth::Cloth(const Cloth& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
Cloth::Cloth(Cloth&&) noexcept = default;
Cloth& Cloth::operator=(const Cloth& other) {
  if (this != &other) parts_ = std::make_unique<Parts>(*other.parts_);
  return *this;
}
Cloth& Cloth::operator=(Cloth&&) noexcept = default;
Cloth::~Cloth() = default;

Cloth Cloth::from_pattern(const std::string& path, const PatternOptions& options) {
  return translated([&] {
    require_above_zero("edge_m", options.edge_m);
    require_at_least_zero("hem_m", options.hem_m);
    require_at_least_zero("tape_m", options.tape_m);
    require_at_least_zero("allowance_m", options.allowance_m);
    if (options.topstitched && options.allowance_m <= 0)
      throw internal::InputError("", "topstitched", "an allowance_m above zero beside it", "none");
    auto parts = std::make_unique<Parts>();
    parts->cloth.kind =
        internal::ScenePattern{path, {}, {options.hem_m, options.tape_m, options.allowance_m, options.topstitched}};
    parts->cloth.resolution_m = options.edge_m;
    parts->cloth.name = std::filesystem::path(path).stem().string();
    return Cloth(std::move(parts));
  });
}

Cloth Cloth::from_file(const std::string& path, const MeshFileOptions& options) {
  return translated([&] {
    auto parts = std::make_unique<Parts>();
    const internal::SceneClothMesh mesh{path, static_cast<internal::LengthUnit>(options.unit),
                                        static_cast<internal::RestShape>(options.rest_shape)};
    parts->cloth.name = usual_name(mesh);
    parts->cloth.kind = mesh;
    return Cloth(std::move(parts));
  });
}

Cloth Cloth::grid(const GridOptions& options) {
  return translated([&] {
    require_above_zero("width_m", options.width_m);
    require_above_zero("height_m", options.height_m);
    require_above_zero("edge_m", options.edge_m);
    auto parts = std::make_unique<Parts>();
    const internal::SceneGrid grid{options.width_m, options.height_m, options.edge_m};
    parts->cloth.name = usual_name(grid);
    parts->cloth.kind = grid;
    return Cloth(std::move(parts));
  });
}

Cloth Cloth::from_arrays(const ClothArrays& given) {
  return translated([&] {
    auto surface = std::make_shared<internal::ClothSurface>();
    surface->x = engine_vectors(given.vertices_m);
    surface->triangles.assign(given.faces.begin(), given.faces.end());
    surface->uv.reserve(given.uv_m.size());
    for (const CornerUvs& uv : given.uv_m)
      surface->uv.push_back(
          {internal::Vec2(uv[0][0], uv[0][1]), internal::Vec2(uv[1][0], uv[1][1]), internal::Vec2(uv[2][0], uv[2][1])});
    surface->panel.assign(given.panel.begin(), given.panel.end());
    surface->panel_names.assign(given.panel_names.begin(), given.panel_names.end());
    auto parts = std::make_unique<Parts>();
    const internal::SceneClothArrays arrays{std::move(surface)};
    parts->cloth.name = usual_name(arrays);
    parts->cloth.kind = arrays;
    internal::check_garment(parts->cloth.name, internal::cloth_of_surface(*arrays.surface, parts->cloth));
    return Cloth(std::move(parts));
  });
}

Cloth& Cloth::set_name(std::string_view name) {
  translated([&] {
    if (name.empty()) throw internal::InputError("", "name", "a name", "an empty string");
  });
  parts_->cloth.name = name;
  return *this;
}

Cloth& Cloth::set_fabric(const Fabric& fabric) {
  parts_->cloth.fabric = translated([&] { return engine_fabric(fabric); });
  return *this;
}

Cloth& Cloth::set_panel_fabric(std::string_view panel, const Fabric& fabric) {
  internal::Fabric engine = translated([&] { return engine_fabric(fabric); });
  panel_of(parts_->cloth, panel).fabric = std::move(engine);
  return *this;
}

Cloth& Cloth::set_panel_rest_stretch(std::string_view panel, double u, double v) {
  translated([&] {
    require_above_zero("u", u);
    require_above_zero("v", v);
  });
  internal::ScenePanel& own = panel_of(parts_->cloth, panel);
  own.rest_stretch_u = u;
  own.rest_stretch_v = v;
  return *this;
}

Cloth& Cloth::set_panel_pressure(std::string_view panel, double Pa) {
  translated([&] { require_pressure("Pa", Pa); });
  internal::ScenePanel& own = panel_of(parts_->cloth, panel);
  own.pressure_Pa = Pa;
  return *this;
}

Cloth& Cloth::place(const Point& translation_m, const Point& rotation_deg) {
  translated([&] {
    require_finite("translation_m", translation_m);
    require_finite("rotation_deg", rotation_deg);
  });
  parts_->cloth.translation_m = engine_vector(translation_m);
  parts_->cloth.rotation_deg = engine_vector(rotation_deg);
  return *this;
}

}  // namespace toile
