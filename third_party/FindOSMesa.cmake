# Off-screen Mesa (Debian: libosmesa6-dev). Defines OSMesa::Headers and OSMesa_SONAME, the library's name, by which it is loaded at run time.
find_path(OSMesa_INCLUDE_DIR GL/osmesa.h)
find_library(OSMesa_LIBRARY OSMesa)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OSMesa REQUIRED_VARS OSMesa_LIBRARY OSMesa_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install libosmesa6-dev")

if(OSMesa_FOUND AND NOT TARGET OSMesa::Headers)
  get_filename_component(OSMesa_REAL_LIBRARY ${OSMesa_LIBRARY} REALPATH)
  string(REGEX MATCH "libOSMesa\\.so\\.[0-9]+" OSMesa_SONAME ${OSMesa_REAL_LIBRARY})
  add_library(OSMesa::Headers INTERFACE IMPORTED)
  set_target_properties(OSMesa::Headers PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${OSMesa_INCLUDE_DIR})
endif()
mark_as_advanced(OSMesa_INCLUDE_DIR OSMesa_LIBRARY)
