// Which Toile a program runs with.
#include <toile/version.hpp>

#include <cstdio>

int main() { std::printf("toile %s\n", toile::version()); }
