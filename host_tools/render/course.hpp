// SPDX-License-Identifier: MIT
// How far a render is, all its stages together. Enters: the quality, and the progress of each machine in turn; leaves:
// a share that never falls.
#pragma once

#include "host_tools/render/render.hpp"

namespace torolux {

class Course {
 public:
  /// radiosity_given: no radiosity stage is run, and no drafts.
  Course(const Quality& quality, bool radiosity_given);

  /// Another machine begins: the next draft's, or after the last of them the one that makes the picture.
  void begin_machine();
  /// So many have run before, in another process.
  void skip_machines(unsigned machines);
  unsigned machines() const { return machines_; }  ///< that have begun
  /// 0..1, of the work of all machines: the present one's stages by their own shares. Rough: what a stage takes is
  /// foretold from the number of records and rays that the quality asks for.
  double share(const RenderProgress& progress);

 private:
  // In units of one record of the radiosity stage.
  double of_draft_, of_radiosity_, of_rays_;
  double of_drafts_;  ///< all of them
  unsigned drafts_left_;
  bool is_draft_ = false;
  unsigned machines_ = 0;
  double before_ = 0;  ///< work of the machines that have ended
  bool radiosity_over_;
  double share_ = 0;
};

}  // namespace torolux
