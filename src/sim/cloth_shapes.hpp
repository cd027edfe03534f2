// sim/cloth_shapes.hpp: cloth that is not sewn: sheets, tubes and ribbons of one panel, whose rest shape is a rectangle.
#pragma once
#include "garment/garment_mesh.hpp"
#include "sim/scene.hpp"

namespace toile::internal {

// The cloth's grid, tube or ribbon, placed; one panel with the cloth's name.
//   grid    in the plane z = 0, facing +z
//   tube    around the y axis, facing outwards; u runs up
//   ribbon  along a curve through the points of its path (centripetal Catmull-Rom [Yuksel 2011], by arc length), and turning as
//           little as it can [Wang 2008]; u runs along it.  A closed one is turned evenly besides, so that its ends meet: by
//           less than half a turn.
// Lengths in the drawing are those of the curve, so that only bending is strained at the start.
GarmentMesh shaped_cloth(const SceneCloth& cloth);

}  // namespace toile::internal
