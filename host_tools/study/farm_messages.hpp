// SPDX-License-Identifier: MIT
// What rank 0 of a study and the others tell each other, and its bytes; all run the same program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/ranks/content.hpp"
#include "host_tools/study/hands.hpp"

namespace torolux::study {

using ranks::bytes_of;
using ranks::content_of;

enum class FarmMessage : std::uint32_t {
  greeting = 1,  ///< to rank 0: Greeting
  order,         ///< from rank 0: FarmOrder
  answer,        ///< to rank 0: FarmAnswer
  leaving,       ///< to rank 0, empty: this rank was told to end; what it was doing is not answered
  end,           ///< from rank 0, empty: stop what you do
  ready,         ///< to rank 0, empty: that has been done
  close          ///< from rank 0: FarmClose
};

struct Greeting {
  std::string host, program;  ///< program: its digest

  template <class Archive>
  void archive(Archive& archive) {
    archive(host, program);
  }
};

struct FarmOrder {
  std::string folder;  ///< where it runs: paths are relative to that
  Order order;

  template <class Archive>
  void archive(Archive& archive) {
    archive(folder, order);
  }
};

struct FarmAnswer {
  std::uint64_t number = 0;
  std::int32_t exit_code = 0;
  std::string errors, result;

  template <class Archive>
  void archive(Archive& archive) {
    archive(number, exit_code, errors, result);
  }
};

struct FarmClose {
  std::vector<unsigned> lost;  ///< ranks
  std::int32_t exit_code = 0;

  template <class Archive>
  void archive(Archive& archive) {
    archive(lost, exit_code);
  }
};

}  // namespace torolux::study
