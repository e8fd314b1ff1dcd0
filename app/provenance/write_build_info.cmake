# Writes OUT, the source file with the one object of build_info.h, if it is not there yet or says anything else.
# cmake -D SOURCE=folder -D OUT=file -D COMPILER=text -D FLAGS=text -P write_build_info.cmake
set(commit unknown)
find_program(GIT git)
if(GIT)
  # A source tree may lie unpacked within another repository, whose commit says nothing about it.
  execute_process(COMMAND ${GIT} rev-parse --show-toplevel WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE top ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  file(REAL_PATH ${SOURCE} source)
  if(top STREQUAL source)
    execute_process(COMMAND ${GIT} describe --always --exclude=* --abbrev=40 --dirty=+changes WORKING_DIRECTORY ${SOURCE}
      RESULT_VARIABLE status OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(status EQUAL 0 AND described)
      set(commit ${described})
    endif()
  endif()
endif()

string(STRIP "${FLAGS}" FLAGS)
set(text "#include \"app/provenance/build_info.h\"\n
namespace app {\n
const BuildInfo kBuildInfo = {R\"(${commit})\", R\"(${COMPILER})\", R\"(${FLAGS})\"};\n
}  // namespace app\n")
set(before "")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
