# A package for Debian 12 with the program, its scenes and shaders, and the library: `cpack --config build/portable/CPackConfig.cmake`.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME drench)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Drench <drench@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulation of liquid meeting fabric, with PolyPIC transfers")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is no library that the program is linked with: it draws by OSMesa, loaded when it is needed, writes in DejaVu, and has videos made by ffmpeg.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6, fonts-dejavu-core, ffmpeg")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "g++, cmake, libtbb-dev, libfmt-dev, libmuparser-dev, libxxhash-dev, libyaml-cpp-dev, libpng-dev")  # for the library
include(CPack)
