// apps/cli/run_directory_command.cpp: `toile verify` and `toile preview`: commands on a finished run.
#include "commands.hpp"
#include "io/json_text.hpp"
#include "io/run_folder.hpp"
#include "preview/looks.hpp"
#include "preview/preview.hpp"
#include "sim/picture_run.hpp"
#include "sim/report.hpp"
#include "terminal.hpp"
#include "verify/verdict.hpp"

#include <fmt/printf.h>

#include <cstdio>
#include <filesystem>

namespace toile::internal {
namespace {

void add_count(JsonText& json, std::string_view key, const PenetrationCount& count) {
  json.key(key);
  json.begin_object();
  json.member("max", count.max);
  json.member("last", count.last);
  json.member("frames", count.frames);
  json.end_object();
}

constexpr std::size_t most_lines = 10;

// {"edge": [12, 40], "edge_of": "cloth", "triangle": 7, "triangle_of": "body", "position_m": [x, y, z]}
void add_crossings(JsonText& json, const std::vector<Crossing>& crossings, bool with_body) {
  for (const Crossing& c : crossings) {
    json.begin_object();
    json.key("edge");
    json.begin_array();
    for (const Index i : c.edge) json.value(i);
    json.end_array();
    json.member("edge_of", c.edge_of_body ? "body" : "cloth");
    json.member("triangle", c.triangle);
    json.member("triangle_of", with_body && !c.edge_of_body ? "body" : "cloth");
    json.key("position_m");
    json.begin_array();
    for (const double coordinate : c.position) json.value(coordinate);
    json.end_array();
    json.end_object();
  }
}

std::string as_line(const Crossing& c, bool with_body) {
  return fmt::sprintf("    edge %d-%d of the %s through triangle %d of the %s at (%.3f, %.3f, %.3f) m\n", c.edge[0],
                      c.edge[1], c.edge_of_body ? "body" : "cloth", c.triangle,
                      with_body && !c.edge_of_body ? "body" : "cloth", c.position.x(), c.position.y(), c.position.z());
}

// The first few; --json has all.
std::string crossings_as_text(const VerifyReport& audit) {
  std::string out;
  const std::size_t all = audit.worst_body_crossings.size() + audit.worst_cloth_crossings.size();
  if (all == 0) return out;
  out += fmt::sprintf("  frame %d has most crossings, %d of an edge and a triangle:\n", audit.worst_frame,
                      static_cast<int>(all));
  std::size_t shown = 0;
  for (const bool with_body : {true, false})
    for (const Crossing& c : with_body ? audit.worst_body_crossings : audit.worst_cloth_crossings)
      if (shown < most_lines) {
        ++shown;
        out += as_line(c, with_body);
      }
  if (shown < all) out += fmt::sprintf("    and %d more (--json)\n", static_cast<int>(all - shown));
  return out;
}

std::string as_json(const VerifyReport& audit, const Verdict& verdict) {
  JsonText json;
  json.begin_object();
  add_judgement(json, verdict);
  json.member("frames", audit.frames);
  json.member("finite", audit.finite);
  json.key("penetrations");
  json.begin_object();
  add_count(json, "cloth_body_edges", audit.cloth_body_edges);
  add_count(json, "cloth_body_edges_outside_pinches", audit.outside_pinches);
  add_count(json, "cloth_cloth_edges", audit.cloth_cloth_edges);
  json.end_object();
  json.key("inputs");
  json.begin_object();
  json.member("known", audit.inputs);
  json.member("changed", static_cast<int>(audit.changed_inputs.size()));
  json.member("missing", audit.missing_inputs);
  json.end_object();
  json.key("worst_frame");
  audit.worst_frame >= 0 ? json.value(audit.worst_frame) : json.null();
  json.key("worst_frame_crossings");
  json.begin_array();
  add_crossings(json, audit.worst_body_crossings, true);
  add_crossings(json, audit.worst_cloth_crossings, false);
  json.end_array();
  json.key("stretch");
  json.begin_object();
  json.member("p50", audit.stretch.p50);
  json.member("p99", audit.stretch.p99);
  json.member("max", audit.stretch.max);
  json.end_object();
  json.key("gap_mm");
  json.begin_object();
  json.member("min", audit.gap.min_mm);
  json.member("p50", audit.gap.p50_mm);
  json.member("hover_p50", audit.gap.hover_p50_mm);
  json.member("hover_p90", audit.gap.hover_p90_mm);
  json.end_object();
  json.key("still");
  json.begin_object();
  json.member("speed_mm_per_s_p99", audit.still_mm_per_s_p99);
  json.end_object();
  json.key("jitter");
  if (audit.jitter.windows == 0) {
    json.null();
  } else {
    json.begin_object();
    json.member("speed_mm_per_s_p50", audit.jitter.p50_mm_per_s);
    json.member("speed_mm_per_s_p99", audit.jitter.p99_mm_per_s);
    json.member("speed_mm_per_s_max", audit.jitter.max_mm_per_s);
    json.member("vertex", audit.jitter.worst_vertex);
    json.member("frame", audit.jitter.worst_frame);
    json.end_object();
  }
  add_slip(json, audit.slip);
  json.end_object();
  return json.str() + '\n';
}

std::string as_text(const std::string& directory, const VerifyReport& audit, const Verdict& verdict) {
  std::string out = directory + ": " + judgement_line(verdict) + '\n' + judgement_details(verdict);
  out += fmt::sprintf("  %d frames, %s\n", audit.frames, audit.finite ? "all finite" : "not finite");
  const auto line = [&](const char* what, const PenetrationCount& count) {
    out += fmt::sprintf("  edges through triangles, %s: last frame %d, most %d, in %d frames\n", what, count.last,
                        count.max, count.frames);
  };
  if (audit.has_body) line("cloth and body", audit.cloth_body_edges);
  if (audit.cloth_body_edges.frames > 0) line("of them where the body leaves room", audit.outside_pinches);
  line("cloth and cloth", audit.cloth_cloth_edges);
  out += crossings_as_text(audit);
  out += fmt::sprintf("  stretch p50 %.2f %%, p99 %.2f %%, max %.2f %%; shear p99 %.1f degrees; still %.2f mm/s\n",
                      100 * audit.stretch.p50, 100 * audit.stretch.p99, 100 * audit.stretch.max,
                      audit.stretch.shear_p99_deg, audit.still_mm_per_s_p99);
  if (audit.jitter.windows > 0) {
    out += fmt::sprintf("  jitter p50 %.1f mm/s, p99 %.1f mm/s, max %.1f mm/s: vertex %d, frame %d\n",
                        audit.jitter.p50_mm_per_s, audit.jitter.p99_mm_per_s, audit.jitter.max_mm_per_s,
                        audit.jitter.worst_vertex, audit.jitter.worst_frame);
  }
  out += slip_line(audit.slip);
  if (audit.has_body) {
    out += fmt::sprintf(
        "  gap to the body: least %.2f mm, median %.2f mm; where it lies on it, median %.2f mm, p90 %.2f mm\n",
        audit.gap.min_mm, audit.gap.p50_mm, audit.gap.hover_p50_mm, audit.gap.hover_p90_mm);
  }
  if (audit.inputs > 0) {
    out += fmt::sprintf("  files that it read: %d, %d of them changed since, %d no longer there\n", audit.inputs,
                        static_cast<int>(audit.changed_inputs.size()), audit.missing_inputs);
  }
  return out;
}

}  // namespace

ExitCode verify_command(const CommandLine& line) {
  if (line.picture) require_pictures();
  const std::string& directory = line.inputs.front();
  const VerifyReport audit = verify_directory(directory);
  Limits limits;
  limits.must_be_still = audit.must_be_still;
  const Verdict verdict = judge(audit, limits);
  if (line.json) {
    print(as_json(audit, verdict));
  } else if (!line.quiet) {
    print(as_text(directory, audit, verdict));
  }
  if (line.picture && audit.worst_frame >= 0) {
    const RunFolder folder(directory, RunFolder::Use::pictures, {}, {});
    const std::string png = (std::filesystem::path(directory) / "crossings.png").string();
    picture_crossings(directory, audit.worst_frame, png);
    if (!line.json && !line.quiet) print(png + '\n');
  }
  tell_failure(directory, verdict);
  return verdict.pass ? ExitCode::ok : ExitCode::simulation_failed;
}

ExitCode preview_command(const CommandLine& line) {
  require_pictures();
  const std::string& directory = line.inputs.front();
  PictureOptions pictures = line.style == "studio" ? studio_pictures() : PictureOptions{};
  std::vector<std::string> inputs;
  if (!line.looks.empty()) {
    const auto looks = std::make_shared<const Looks>(Looks::load(line.looks));
    inputs = looks->files();
    pictures.looks = looks;
  }
  const RunFolder folder(directory, RunFolder::Use::pictures, {}, inputs);
  ProgressBar bar(line);
  pictures.frames = line.frames;
  if (!line.close_up_m.empty()) pictures.close_up_m = Vec3(line.close_up_m[0], line.close_up_m[1], line.close_up_m[2]);
  pictures.turntable = line.turntable;
  pictures.film = !line.no_film;
  picture_run(
      directory, pictures,
      [&](double share) {
        bar.show({"picturing", share, -1});
      },
      interrupted);
  bar.clear();
  std::vector<std::pair<const char*, std::string>> made = {{"png", "preview.png"}};
  if (pictures.film) made.emplace_back("mp4", "preview.mp4");
  if (!line.frames.empty()) made.emplace_back("frames", "frames.png");
  if (pictures.close_up_m) made.emplace_back("close_up", "close-up.png");
  if (line.turntable) made.emplace_back("turntable", "turntable.mp4");
  JsonText json(0);
  json.begin_object();
  for (const auto& [key, name] : made) json.member(key, folder.path(name));
  json.end_object();
  if (line.json) {
    print(json.str() + '\n');
  } else if (!line.quiet) {
    for (const auto& [key, name] : made) print(folder.path(name) + '\n');
  }
  return ExitCode::ok;
}

}  // namespace toile::internal
