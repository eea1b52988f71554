// SPDX-License-Identifier: MIT
// For each scene at each setting a row of the table pictures leaves, with errors and costs; beside it the picture, and
// its difference, red where it is too bright, blue where too dark.
#include "tests/accuracy/picture_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "emulator/errors.hpp"
#include "host_tools/picture/visible_difference.hpp"
#include "tests/accuracy/table.hpp"
#include "tests/references/picture_error.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::accuracy {
namespace {

/// The difference as a picture: brighter than the reference is red, darker is blue.
Picture signed_difference(const Picture& picture, const Picture& reference, double clamp) {
  Picture result = reference;
  const auto most = static_cast<float>(clamp);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    float difference = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      difference += std::min(picture.pixels[i][c], most) - std::min(reference.pixels[i][c], most);
    }
    result.pixels[i] = {std::max(difference, 0.0F), 0.0F, std::max(-difference, 0.0F)};
  }
  return result;
}

struct Reference {
  references::TracedPicture traced;
  double noise;
  double flip_of_halves;  ///< mean, between its two halves, which differ by twice its noise
};

std::vector<std::string> visible_cells(const Picture& picture, const Reference& reference) {
  const VisibleDifference visible = visible_difference(picture, reference.traced.picture, kPixelsPerDegree);
  return {text_of("%.4f", visible.flip.mean),          text_of("%.4f", visible.flip.percentile_95),
          text_of("%.4f", visible.hdr_flip.mean),      text_of("%.4f", reference.flip_of_halves),
          text_of("%.3f", visible.streaks.directed),   text_of("%.3f", visible.streaks.error),
          text_of("%.1f", 100 * visible.streaks.share)};
}

void add_row(Table& table, const SceneRun& run, const Reference& reference, const Setting& setting,
             const ReportChoice& choice) {
  Quality quality = quality_at(setting, run.scene);
  quality.width = run.resolved.quality.width;
  quality.height = run.resolved.quality.height;
  const double before = cpu_seconds();
  const RenderResult result =
      render(run.scene, run.resolved.camera, quality, run.resolved.machine, {}, test::pe_image(), {});
  const double seconds = cpu_seconds() - before;
  const references::PictureError error = references::picture_error(result.picture, reference.traced.picture);
  const auto length = [](const std::optional<double>& value) { return value ? text_of("%.4g", *value) : "auto"; };
  const auto& energy = result.figures.energy;
  std::vector<std::string> cells = {
      run.scene.name,
      std::string(setting.name),
      length(quality.patch_length),
      length(quality.element_length),
      std::to_string(quality.hemicube),
      std::to_string(quality.shot_points),
      text_of("%g", quality.unshot),
      std::to_string(quality.samples),
      text_of("%g", quality.refine),
      quality.shadow_rays ? "shadow rays" : "elements",
      text_of("%.2f", 100 * error.plain_mean),
      text_of("%.2f", 100 * error.mean),
      text_of("%.2f", 100 * error.rmse),
      text_of("%.2f", 100 * reference.noise),
      text_of("%.2f", 100 * std::sqrt(std::fmax(0, error.rmse * error.rmse - reference.noise * reference.noise))),
      std::to_string(result.figures.radiosity_records),
      std::to_string(result.figures.rays),
      text_of("%.2f", 100 * energy.unshot[1] / energy.emitted[1]),
      text_of("%.1f", seconds)};
  const std::vector<std::string> visible = visible_cells(result.picture, reference);
  cells.insert(cells.end(), visible.begin(), visible.end());
  table.add(std::move(cells));
  const std::string stem = (choice.output / (run.scene.name + "-" + std::string(setting.name))).string();
  write_picture(result.picture, stem + ".exr");
  write_picture(signed_difference(result.picture, reference.traced.picture, error.clamp), stem + "-difference.png");
}

void add_scene(Table& table, const std::filesystem::path& path, const ReportChoice& choice) {
  const SceneRun run = resolve_scene(path, choice);
  const Quality& quality = run.resolved.quality;
  Reference reference{
      reference_picture(run.scene, {run.resolved.camera, quality.two_sided_lights}, {quality.width, quality.height},
                        choice.reference, choice.threads, choice.output / "references"),
      0, 0};
  reference.noise = references::reference_noise(reference.traced);
  reference.flip_of_halves =
      visible_difference(reference.traced.first_half, reference.traced.second_half, kPixelsPerDegree).flip.mean;
  write_picture(reference.traced.picture, choice.output / (run.scene.name + "-reference.exr"));
  write_picture(reference.traced.picture, choice.output / (run.scene.name + "-reference.png"), run.resolved.tone);
  for (const Setting& setting : chosen_settings(choice)) add_row(table, run, reference, setting, choice);
}

}  // namespace

void report_pictures(const ReportChoice& choice) {
  std::filesystem::create_directories(choice.output);
  Table table({"scene",
               "setting",
               "patches",
               "elements",
               "hemicube",
               "shot points",
               "unshot",
               "samples",
               "refine",
               "direct",
               "mean error [%]",
               "clamped mean error [%]",
               "rel. RMSE [%]",
               "noise of the reference [%]",
               "RMSE without it [%]",
               "records",
               "camera rays",
               "unshot at the end [%]",
               "CPU [s]",
               "FLIP",
               "FLIP 95 %",
               "HDR-FLIP",
               "FLIP of the reference's halves",
               "streaks [L*]",
               "error [L*]",
               "streaks' share [%]"});
  for (const auto& scene : choice.scenes) {
    try {
      add_scene(table, scene, choice);
    } catch (const InputError& error) {
      std::printf("%s is left out: %s\n", scene.string().c_str(), error.what());
    }
    table.write(choice.output / "pictures");
  }
}

}  // namespace torolux::accuracy
