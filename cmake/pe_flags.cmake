# SPDX-License-Identifier: MIT
# pe_flags(SECTION RESULT): the flags of one section of pe_flags.txt, as a list.
set(pe_flags_file ${CMAKE_CURRENT_LIST_DIR}/pe_flags.txt)
function(pe_flags section result)
  file(STRINGS ${pe_flags_file} lines)
  set(current "")
  set(flags "")
  foreach(line IN LISTS lines)
    if(line MATCHES "^-")
      if(current STREQUAL section)
        list(APPEND flags ${line})
      endif()
    elseif(NOT line MATCHES "^#")
      string(REGEX REPLACE "[^a-z+]" "" current "${line}")
    endif()
  endforeach()
  set(${result}
      ${flags}
      PARENT_SCOPE)
endfunction()
