# Toolchain: Debian's emscripten. Programs run in node.
find_program(BN_EMCC emcc REQUIRED)
file(REAL_PATH ${BN_EMCC} emcc)
foreach(root $ENV{EMSDK}/upstream/emscripten /usr/share/emscripten)
  if(EXISTS ${root}/cmake/Modules/Platform/Emscripten.cmake)
    set(EMSCRIPTEN_ROOT_PATH ${root})
    break()
  endif()
endforeach()
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
set(CMAKE_CROSSCOMPILING_EMULATOR node --no-experimental-fetch) # node's own fetch refuses the paths that emscripten 3.1 gives it
