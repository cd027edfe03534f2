// Against a libtoile that was built without pictures: asking for one is an error, which comes out of the library as what it is.
#include <toile/error.hpp>
#include <toile/run.hpp>

#include <cstdio>

int main() {
  try {
    toile::preview(".");
  } catch (const toile::Error& error) {
    std::puts(error.what());
    return error.code() == toile::ErrorCode::usage ? 0 : 1;
  }
  return 2;
}
