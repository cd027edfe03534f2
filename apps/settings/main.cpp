// apps/settings/main.cpp: writes docs/scene.schema.json and the tables of docs/scenes.md.   The test Settings.TheDocumentsAreCurrent
// fails until this is run after a change of a description (sim/settings.hpp).
#include "sim/settings_catalogue.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: toile_settings DOCS\n", stderr);
    return 2;
  }
  const std::string docs = argv[1], page = docs + "/scenes.md";
  const toile::internal::SettingNode scene = toile::internal::scene_settings();
  std::ifstream in(page);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string begin(toile::internal::settings_begin), end(toile::internal::settings_end);
  const std::size_t from = text.find(begin), to = text.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    std::fprintf(stderr, "%s: expected the lines '%s' and '%s'\n", page.c_str(), begin.c_str(), end.c_str());
    return 3;
  }
  std::ofstream(docs + "/scene.schema.json") << toile::internal::scene_schema(scene);
  std::ofstream(page) << text.substr(0, from + begin.size()) << "\n\n"
                      << toile::internal::settings_table(scene) << '\n'
                      << text.substr(to);
  std::printf("%zu settings\n", toile::internal::count_settings(scene));
  return 0;
}
