# Flags of the build for WebAssembly, and the libraries that are headers alone. The host's folder of headers cannot be searched, because it
# holds the host's C library.
set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})
foreach(folder glm nlohmann fmt stb)
  find_path(found_${folder} ${folder} PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  file(CREATE_LINK ${found_${folder}}/${folder} ${headers}/${folder} SYMBOLIC)
endforeach()
foreach(name glm::glm nlohmann_json::nlohmann_json)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
endforeach()
# Sizes are 64 bits wide in readers until they are checked against the bytes that are there, and 32 afterwards.
target_compile_options(burnish_flags INTERFACE -Wno-shorten-64-to-32)
# Relaxed SIMD stays off: its fma may round once or twice.
target_compile_options(burnish_flags INTERFACE -msimd128 -mbulk-memory -mnontrapping-fptoint -fwasm-exceptions
  -include ${CMAKE_CURRENT_LIST_DIR}/standard_library.h)
target_compile_definitions(burnish_flags INTERFACE FMT_HEADER_ONLY)
target_include_directories(burnish_flags SYSTEM INTERFACE ${CMAKE_CURRENT_LIST_DIR} ${headers})
target_link_options(burnish_flags INTERFACE -fwasm-exceptions -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB -sTOTAL_STACK=4194304)
set_property(GLOBAL PROPERTY RULE_LAUNCH_LINK "${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs:$ENV{NODE_PATH}") # emcc's own scripts ask for acorn

# bn_node_program(TARGET): a program that node runs, with the machine's own files.
function(bn_node_program target)
  target_link_options(${target} PRIVATE -sNODERAWFS=1 -sEXIT_RUNTIME=1)
endfunction()
