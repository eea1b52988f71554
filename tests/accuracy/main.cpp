// SPDX-License-Identifier: MIT
// `accuracy`: how far the product is from its references. Enters: scenes, settings; leaves: tables and plots in a
// folder.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "tests/accuracy/element_report.hpp"
#include "tests/accuracy/picture_report.hpp"
#include "tests/accuracy/surface_report.hpp"
#include "tests/support/render_support.hpp"

namespace {

using namespace torolux;

std::vector<std::filesystem::path> all_scenes() {
  std::vector<std::filesystem::path> scenes;
  for (const std::string& name : test::scene_names()) scenes.push_back(test::source_dir() / "scenes" / name);
  const char* more = std::getenv("TOROLUX_MORE_SCENES");
  if (more == nullptr) return scenes;
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(more)) {
    if (entry.path().extension() == ".obj") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  scenes.insert(scenes.end(), found.begin(), found.end());
  return scenes;
}

int run(int argc, char** argv) {
  CLI::App app("Compares pictures with the path tracer. TOROLUX_MORE_SCENES: a folder with further .obj files.");
  accuracy::ReportChoice choice;
  choice.output = "accuracy";
  app.add_option("--scene", choice.scenes, "folder, .toml or .obj; absent: all of scenes/ and TOROLUX_MORE_SCENES");
  app.add_option("--setting", choice.settings, "coarse, draft, rough, normal, good, fine; absent: all");
  app.add_option("--engine", choice.engine, "of the product")->capture_default_str();
  app.add_option("--shrink", choice.shrink, "pictures are so many times less wide and high than the scene's own")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--noise", choice.reference.noise, "of the path traced references")->capture_default_str();
  app.add_option("--most-samples", choice.reference.most_samples, "of the references, per pixel")
      ->capture_default_str();
  app.add_option("--threads", choice.threads, "0: all cores")->capture_default_str();
  app.add_option("--output", choice.output, "folder")->capture_default_str();
  std::vector<std::string> reports;
  app.add_option("reports", reports, "form-factors, dense, surfaces, pictures; absent: all")
      ->check(CLI::IsMember({"form-factors", "dense", "surfaces", "pictures"}));
  CLI11_PARSE(app, argc, argv);
  if (choice.scenes.empty()) choice.scenes = all_scenes();
  const auto wanted = [&](const char* name) {
    return reports.empty() || std::find(reports.begin(), reports.end(), name) != reports.end();
  };
  if (wanted("form-factors")) report_form_factors(choice);
  if (wanted("dense")) report_dense(choice);
  if (wanted("surfaces")) report_surfaces(choice);
  if (wanted("pictures")) report_pictures(choice);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "accuracy: %s\n", error.what());
    return 1;
  }
}
