// solver/vector_kernels.hpp: the iteration's loops over particles, by places, compiled for each instruction set.
//
// Four particles at a time.  Products and sums of a dot product are double; each lane of each of the four adds up on
// its own, and at the end they are added in one order: the same bits on every set.  All loops run over places [begin,
// end) of the pattern; vectors begin with place 0.
#pragma once
#include "assembly/lane.hpp"

namespace toile::internal {

// a.b
double dot_lanes(Index begin, Index end, const Lane<float>* a, const Lane<float>* b);
// c = s + beta c,  q = As + beta q, or c = s, q = As at the first iteration;  c.q
double next_direction(Index begin, Index end, bool first, float beta, const Lane<float>* s, const Lane<float>* As,
                      Lane<float>* c, Lane<float>* q);
// w += alpha c,  r -= alpha q;  r.G r
double next_residual(Index begin, Index end, float alpha, const Lane<float>* c, const Lane<float>* q,
                     const Block<float>* G, Lane<float>* w, Lane<float>* r);
// r.G r
double residual_norm2(Index begin, Index end, const Block<float>* G, const Lane<float>* r);
// sum[9 aggregate + 3 l + c] += basis function l times (r - At)_c, over the particles of each aggregate; `basis` is (1,
// u, v).  Sums run over neighbours in the order of places, mostly of one aggregate.
void add_moments(Index begin, Index end, const Lane<float>* r, const Lane<float>* At, const Vec3* basis,
                 const Index* aggregate, double* sum);

// The same in double, one particle at a time.
double dot_lanes(Index begin, Index end, const Lane<double>* a, const Lane<double>* b);
double next_direction(Index begin, Index end, bool first, double beta, const Lane<double>* s, const Lane<double>* As,
                      Lane<double>* c, Lane<double>* q);
double next_residual(Index begin, Index end, double alpha, const Lane<double>* c, const Lane<double>* q,
                     const Block<double>* G, Lane<double>* w, Lane<double>* r);
double residual_norm2(Index begin, Index end, const Block<double>* G, const Lane<double>* r);
void add_moments(Index begin, Index end, const Lane<double>* r, const Lane<double>* At, const Vec3* basis,
                 const Index* aggregate, double* sum);

}  // namespace toile::internal
