#include "sim/report.hpp"

#include "io/json_text.hpp"
#include "io/run_folder.hpp"

#ifndef TOILE_VERSION
#error "TOILE_VERSION comes from the build"
#endif

namespace toile::internal {
namespace {

void add(JsonText& text, std::string_view key, const PenetrationCount& count) {
  text.key(key);
  text.begin_object();
  text.member("max", count.max);
  text.member("last", count.last);
  text.member("frames", count.frames);
  text.end_object();
}

void add_seconds_per_frame(JsonText& text, const PhaseReport& phase) {
  const double n = phase.frames > 0 ? phase.frames : 1;
  const double parts = phase.eval + phase.cg + phase.cloth_cloth + phase.cloth_solid + phase.body;
  text.key("seconds_per_frame");
  text.begin_object();
  text.member("total", phase.seconds / n);
  text.member("eval", phase.eval / n);
  text.member("cg", phase.cg / n);
  text.member("cloth_cloth", phase.cloth_cloth / n);
  text.member("safe_filter", phase.filter / n);
  text.member("cloth_solid", phase.cloth_solid / n);
  text.member("body", phase.body / n);
  text.member("other", (phase.seconds - parts) / n);
  text.end_object();
}

void add_startup(JsonText& text, const StartupReport& startup) {
  const double parts = startup.scene + startup.cloth + startup.body + startup.placement + startup.crossings;
  text.key("startup_seconds");
  text.begin_object();
  text.member("total", startup.total);
  text.member("scene", startup.scene);
  text.member("cloth", startup.cloth);
  text.member("body", startup.body);
  text.member("placement", startup.placement);
  text.member("crossings", startup.crossings);
  text.member("other", startup.total - parts);
  text.end_object();
}

void add_steps(JsonText& text, const PhaseReport& phase) {
  text.member("steps", phase.steps);
  text.member("steps_rejected", phase.steps_rejected);
  text.member("step_min_ms", 1e3 * phase.step_min_s);
  text.member("step_max_ms", 1e3 * phase.step_max_s);
  text.key("safe_filter");
  text.begin_object();
  text.member("steps_met", phase.met);
  text.member("steps_refused", phase.refused);
  text.member("corrected", phase.corrected);
  text.member("truncated", phase.truncated);
  text.member("pierced", phase.pierced);
  text.end_object();
  text.member("pinched_max", phase.pinched);
}

void add_cg(JsonText& text, const PhaseReport& phase) {
  text.key("cg_iterations");
  text.begin_object();
  text.member("mean",
              phase.steps > 0 ? static_cast<double>(phase.cg_iterations) / static_cast<double>(phase.steps) : 0.0);
  text.member("max", phase.cg_max);
  text.end_object();
}

void add_verdict(JsonText& text, const Report& report) {
  add_judgement(text, report.verdict);
  const Limits& limits = report.verdict.limits;
  text.key("limits");
  text.begin_object();
  text.member("cloth_body_edges", limits.cloth_body_edges);
  text.member("cloth_cloth_edges", limits.cloth_cloth_edges);
  text.member("stretch_p99", limits.stretch_p99);
  text.member("stretch_max", limits.stretch_max);
  text.member("slip_cm", 100 * limits.slip_m);
  text.member("shoulder_slip_cm", 100 * limits.shoulder_slip_m);
  text.key("still_mm_per_s");
  if (limits.must_be_still) {
    text.value(limits.still_mm_per_s);
  } else {
    text.null();
  }
  text.end_object();
}

void add_jitter(JsonText& text, const JitterStatistics& jitter) {
  text.key("jitter");
  if (jitter.windows == 0) {
    text.null();
    return;
  }
  text.begin_object();
  text.member("speed_mm_per_s_p50", jitter.p50_mm_per_s);
  text.member("speed_mm_per_s_p99", jitter.p99_mm_per_s);
  text.member("speed_mm_per_s_max", jitter.max_mm_per_s);
  text.end_object();
}

void add_measurements(JsonText& text, const Report& report) {
  const StretchStatistics& s = report.audit.stretch;
  text.key("stretch");
  text.begin_object();
  text.member("p50", s.p50);
  text.member("p99", s.p99);
  text.member("max", s.max);
  text.member("judged_p99", s.triangle_p99);
  text.member("judged_max", s.triangle_max);
  text.member("gauge_p99", s.gauge_p99);
  text.member("gauge_max", s.gauge_max);
  text.end_object();
  text.key("shear_degrees");
  text.begin_object();
  text.member("p50", s.shear_p50_deg);
  text.member("p99", s.shear_p99_deg);
  text.member("max", s.shear_max_deg);
  text.end_object();
  text.key("start");
  text.begin_object();
  text.member("cloth_cloth_edges", report.start.cloth_cloth);
  text.member("cloth_body_edges", report.start.cloth_body);
  text.member("cloth_cloth_edges_left", report.start.cloth_cloth_left);
  text.member("cloth_body_edges_left", report.start.cloth_body_left);
  text.member("trials", report.start.trials);
  text.member("largest_move_mm", report.start.largest_move_mm);
  text.end_object();
  text.key("penetrations");
  text.begin_object();
  add(text, "cloth_body_edges", report.audit.cloth_body_edges);
  add(text, "cloth_body_edges_outside_pinches", report.audit.outside_pinches);
  add(text, "cloth_cloth_edges", report.audit.cloth_cloth_edges);
  text.end_object();
  text.key("gap_mm");
  text.begin_object();
  text.key("min");
  report.audit.has_body ? text.value(report.audit.gap.min_mm) : text.null();
  text.key("p50");
  report.audit.has_body ? text.value(report.audit.gap.p50_mm) : text.null();
  text.key("hover_p50");
  report.audit.has_body ? text.value(report.audit.gap.hover_p50_mm) : text.null();
  text.key("hover_p90");
  report.audit.has_body ? text.value(report.audit.gap.hover_p90_mm) : text.null();
  text.end_object();
  text.key("layer_gap");
  if (report.layer_gap.pairs == 0) {
    text.null();
  } else {
    const LayerGap& gap = report.layer_gap;
    text.begin_object();
    text.member("particles", gap.particles);
    text.member("min_mm", 1e3 * gap.least_m);
    text.key("p50_mm");
    gap.particles > 0 ? text.value(1e3 * gap.median_m) : text.null();
    text.member("min_of_asked", gap.least_share);
    text.key("p50_of_asked");
    gap.particles > 0 ? text.value(gap.median_share) : text.null();
    text.end_object();
  }
  text.key("still");
  text.begin_object();
  text.member("speed_mm_per_s_p99", report.audit.still_mm_per_s_p99);
  text.end_object();
  add_jitter(text, report.audit.jitter);
  add_slip(text, report.audit.slip);
}

void add_point(JsonText& text, std::string_view key, const Vec3& p) {
  text.key(key);
  text.begin_array();
  for (const double d : p) text.value(d);
  text.end_array();
}

void add_open_seams(JsonText& text, const Report& report) {
  text.key("open_seams");
  text.begin_array();
  for (const OpenSeam& seam : report.open_seams) {
    text.begin_object();
    text.member("name", seam.name);
    text.member("gap_mm", 1e3 * seam.gap_m);
    add_point(text, "where_m", seam.where);
    text.key("vertices");
    text.begin_array();
    for (const auto& pair : seam.vertices) {
      text.begin_array();
      for (const Index i : pair) text.value(i);
      text.end_array();
    }
    text.end_array();
    text.end_object();
  }
  text.end_array();
}

void add_rest_stretch(JsonText& text, const Report& report) {
  if (!report.rest_stretch.empty()) {
    text.key("rest_stretch");
    text.begin_object();
    for (const auto& [panel, b] : report.rest_stretch) {
      text.key(panel);
      text.begin_array();
      text.value(b[0]);
      text.value(b[1]);
      text.end_array();
    }
    text.end_object();
  }
}

void add_fabrics(JsonText& text, const Report& report) {
  text.key("fabrics");
  text.begin_array();
  for (const Report::PanelFabric& panel : report.fabrics) {
    text.begin_object();
    text.member("garment", panel.garment);
    text.member("panel", panel.panel);
    text.member("fabric", panel.fabric);
    text.end_object();
  }
  text.end_array();
}

void add_inputs(JsonText& text, const Report& report) {
  text.key("inputs");
  text.begin_array();
  for (const InputFile& input : report.inputs) {
    text.begin_object();
    text.member("path", input.path);
    text.member("checksum", input.checksum);
    text.end_object();
  }
  text.end_array();
}

// Pictures belong to the run, too, and may be made at any time: they are listed without a checksum.
void add_files(JsonText& text, const Report& report) {
  text.key("files");
  text.begin_object();
  for (const WrittenFile& file : report.files) {
    text.key(file.name);
    text.begin_object();
    if (file.frames.empty()) {
      text.member("checksum", file.checksum);
    } else {
      text.member("header_checksum", file.checksum);
      text.key("frame_checksums");
      text.begin_array();
      for (const std::string& frame : file.frames) text.value(frame);
      text.end_array();
    }
    text.end_object();
  }
  for (const std::string_view name : picture_file_names) {
    text.key(name);
    text.null();
  }
  text.end_object();
}

}  // namespace

void add_judgement(JsonText& text, const Verdict& verdict) {
  text.member("verdict", verdict.pass ? "pass" : "fail");
  const auto add = [&](std::string_view codes, std::string_view details, const std::vector<Reason>& reasons) {
    text.key(codes);
    text.begin_array();
    for (const Reason& reason : reasons) text.value(reason.code);
    text.end_array();
    text.key(details);
    text.begin_object();
    for (const Reason& reason : reasons) text.member(reason.code, reason.detail);
    text.end_object();
  };
  add("reasons", "reason_details", verdict.reasons);
  add("qualifications", "qualification_details", verdict.qualifications);
}

std::string judgement_line(const Verdict& verdict) {
  if (!verdict.pass) return "fail";
  if (verdict.qualifications.empty()) return "pass";
  std::string line = "pass, with reservations";
  for (std::size_t k = 0; k < verdict.qualifications.size(); ++k)
    line += (k == 0 ? ": " : ", ") + verdict.qualifications[k].code;
  return line;
}

std::string judgement_details(const Verdict& verdict) {
  std::string lines;
  for (const std::vector<Reason>* reasons : {&verdict.reasons, &verdict.qualifications})
    for (const Reason& reason : *reasons) lines += "  " + reason.code + ": " + reason.detail + '\n';
  return lines;
}

std::string_view toile_version() { return TOILE_VERSION; }

void add_facts(JsonText& json, const Report& report) {
  json.member("fps", report.fps);
  json.member("body_vertices", report.body_vertices);
  json.member("motion_first_frame", report.motion_first_frame);
  add_rest_stretch(json, report);
}

std::string to_json(const Report& report, int indent) {
  JsonText text(indent);
  text.begin_object();
  text.member("toile_version", toile_version());
  text.member("name", report.name);
  text.member("command", report.command);
  text.member("input_hash", report.input_hash);
  text.member("state_hash", report.state_hash);
  add_verdict(text, report);
  text.member("ended", report.ended);
  text.key("warnings");
  text.begin_array();
  for (const std::string& warning : report.warnings) text.value(warning);
  text.end_array();
  text.member("threads", report.threads);
  text.key("units");
  text.begin_object();
  text.member("length", "m");
  text.member("time", "s");
  text.member("mass", "kg");
  text.member("up", "y");
  text.end_object();
  text.key("cloth");
  text.begin_object();
  text.member("vertices", report.vertices);
  text.member("triangles", report.triangles);
  text.member("panels", report.panels);
  text.member("seams", report.seams);
  text.end_object();
  text.key("body");
  text.begin_object();
  text.member("vertices", report.body_vertices);
  text.member("triangles", report.body_triangles);
  text.end_object();
  text.member("fps", report.fps);
  text.member("frames", report.frames);
  add_steps(text, report.drape);
  text.member("seconds_total", report.seconds_total);
  add_startup(text, report.startup);
  add_seconds_per_frame(text, report.drape);
  add_cg(text, report.drape);
  add_rest_stretch(text, report);
  add_fabrics(text, report);
  add_measurements(text, report);
  text.key("sewing");
  if (report.seams == 0) {
    text.null();
  } else {
    text.begin_object();
    text.member("frames", report.sewing.frames);
    text.member("simulated_s", report.sewing.simulated_s);
    text.member("seconds", report.sewing.seconds);
    add_steps(text, report.sewing);
    add_seconds_per_frame(text, report.sewing);
    add_cg(text, report.sewing);
    add_point(text, "shift_m", report.shift_m);
    text.end_object();
  }
  add_open_seams(text, report);
  text.key("motion");
  if (report.motion_first_frame < 0) {
    text.null();
  } else {
    text.begin_object();
    text.member("name", report.motion_name);
    text.member("first_frame", report.motion_first_frame);
    text.member("frames", report.motion.frames);
    text.member("simulated_s", report.motion.simulated_s);
    text.member("seconds", report.motion.seconds);
    add_steps(text, report.motion);
    add_seconds_per_frame(text, report.motion);
    add_cg(text, report.motion);
    text.end_object();
  }
  text.member("peak_memory_mb", report.peak_memory_mb);
  add_inputs(text, report);
  add_files(text, report);
  text.end_object();
  return text.str();
}

}  // namespace toile::internal
