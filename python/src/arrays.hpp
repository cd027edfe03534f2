// arrays.hpp: arrays of Python as spans of the library, and back.
//
// toile/_arrays.py has converted and checked the arguments; here they are read in place.  Results are read-only copies owned by the array:
// later changes of the simulation do not reach them.
#pragma once
#include <toile/types.hpp>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <span>
#include <vector>

namespace toile::python {

namespace nb = nanobind;

template <class T, class Shape>
using In = nb::ndarray<const T, Shape, nb::c_contig, nb::device::cpu>;
using PointsIn = In<double, nb::shape<-1, 3>>;
using FacesIn = In<std::int32_t, nb::shape<-1, 3>>;
using CornerUvsIn = In<double, nb::shape<-1, 3, 2>>;
using IndicesIn = In<std::int32_t, nb::ndim<1>>;
using FramesIn = In<double, nb::shape<-1, -1, 3>>;

template <class T>
using Out = nb::ndarray<nb::numpy, const T, nb::c_contig>;

// Arrays of numbers are arrays of small arrays of numbers: no padding, the same alignment.
static_assert(sizeof(Point) == 3 * sizeof(double) && alignof(Point) == alignof(double));
static_assert(sizeof(Face) == 3 * sizeof(std::int32_t) && alignof(Face) == alignof(std::int32_t));
static_assert(sizeof(CornerUvs) == 6 * sizeof(double) && alignof(CornerUvs) == alignof(double));

template <class Element, class Array>
std::span<const Element> elements(const Array& array, std::size_t count) {
  return {reinterpret_cast<const Element*>(array.data()), count};
}
inline std::span<const Point> points(const PointsIn& array) { return elements<Point>(array, array.shape(0)); }
inline std::span<const Face> faces(const FacesIn& array) { return elements<Face>(array, array.shape(0)); }
inline std::span<const std::int32_t> indices(const IndicesIn& array) { return {array.data(), array.shape(0)}; }

// `inner`: the shape of an element.
template <class Number, class Element>
Out<Number> copy_out(std::span<const Element> values, std::initializer_list<std::size_t> inner) {
  static_assert(sizeof(Element) % sizeof(Number) == 0);
  auto* owned = new std::vector<Element>(values.begin(), values.end());
  nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<Element>*>(p); });
  std::vector<std::size_t> shape{values.size()};
  shape.insert(shape.end(), inner);
  return Out<Number>(reinterpret_cast<const Number*>(owned->data()), shape.size(), shape.data(), owner);
}

}  // namespace toile::python
