// Against a libtoile that was built without pictures: asking for one is an error, which comes out of the library as what it is.
#include <toile/error.hpp>
#include <toile/run.hpp>

#include <cstdio>

template <class Ask>
bool is_refused(const Ask& ask) {
  try {
    ask();
  } catch (const toile::Error& error) {
    std::puts(error.what());
    return error.code() == toile::ErrorCode::usage;
  }
  return false;
}

int main() {
  const toile::Simulation sheet(toile::Cloth::grid({0.2, 0.2, 0.05}));
  const bool refused = is_refused([] { toile::preview("."); }) && is_refused([&] { toile::picture(sheet); }) &&
                       is_refused([] { toile::picture("."); });
  return refused ? 0 : 1;
}
