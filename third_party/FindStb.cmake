# The stb single-file libraries (Debian: libstb-dev). Defines Stb::Stb, headers only: #include <stb_truetype.h>.
find_path(Stb_INCLUDE_DIR stb_truetype.h PATH_SUFFIXES stb)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Stb REQUIRED_VARS Stb_INCLUDE_DIR REASON_FAILURE_MESSAGE "install libstb-dev")
if(Stb_FOUND AND NOT TARGET Stb::Stb)
  add_library(Stb::Stb INTERFACE IMPORTED)
  set_target_properties(Stb::Stb PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${Stb_INCLUDE_DIR})
endif()
mark_as_advanced(Stb_INCLUDE_DIR)
