# SPDX-License-Identifier: MIT
# cmake -D SOURCE=checkout -D OUTPUT=commit.hpp -P commit.cmake: writes the checkout's commit.
execute_process(
  COMMAND git -C ${SOURCE} describe --always --abbrev=40 --exclude=* --dirty
  OUTPUT_VARIABLE commit
  RESULT_VARIABLE result
  ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT result EQUAL 0)
  set(commit "")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "inline constexpr const char* kCommit = \"${commit}\";\n")
file(TOUCH ${OUTPUT})
