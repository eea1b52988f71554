// SPDX-License-Identifier: MIT
// The picture that every machine must make of one small render, and what holds after each.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/render_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

inline RenderCase small_cornell(const char* scene = "cornell_box") {
  RenderCase cornell = native_case(source_dir() / "scenes" / scene);
  cornell.quality.hemicube = 8;
  cornell.quality.shot_points = 1;
  cornell.quality.max_shots = 60;
  cornell.quality.patch_length = 200;
  cornell.quality.element_length = 80;
  cornell.machine.columns = cornell.machine.rows = 2;
  cornell.machine.description.records.credits_per_pe = 64;
  cornell.machine.subspaces = {4, 4, 4};
  return cornell;
}

inline void expect_all_home(const RenderResult& result) {
  EXPECT_EQ(result.figures.credits_home, result.figures.credits_total);
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  for (const PeFigures& pe : result.figures.machine.pes) {
    sent += pe.packets_sent;
    delivered += pe.packets_delivered;
  }
  EXPECT_EQ(sent, delivered);
  EXPECT_LT(energy_error(result.figures.energy), 1e-5);
}

struct Solved {
  std::vector<std::byte> picture;
  std::string radiosities;  ///< a file of them: the flux of all elements and sides
  std::string figures;      ///< exact_figures
};

inline Solved solve(RenderCase render_case) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "radiosities";
  render_case.files.save_radiosity = file;
  const RenderResult result = run_case(render_case);
  expect_all_home(result);
  std::ifstream stream(file, std::ios::binary);
  return {bytes_of(result.picture), {std::istreambuf_iterator<char>(stream), {}}, exact_figures(result.figures)};
}

/// The picture that every other machine must make too; with the scene that has mirror and glass.
inline const std::vector<std::byte>& reference_picture() {
  static const std::vector<std::byte> bytes = [] {
    const RenderResult result = run_case(small_cornell("cornell_spheres"));
    expect_all_home(result);
    return bytes_of(result.picture);
  }();
  return bytes;
}

inline void expect_same_picture(const RenderCase& render_case) {
  const RenderResult result = run_case(render_case);
  expect_all_home(result);
  EXPECT_EQ(bytes_of(result.picture), reference_picture());
}

}  // namespace torolux::test
