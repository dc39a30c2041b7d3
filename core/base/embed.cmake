# bn_embed(SOURCE HEADER NAME=FILE...): writes the C++ file SOURCE, which puts files into the program as they are: each as
# `const EmbeddedFile burnish::NAME`, which HEADER declares. The assembler reads them: a compiler takes seconds for a megabyte of numbers.
function(bn_embed source header)
  set(text "#include \"${header}\"\n\nnamespace burnish {\n")
  set(files)
  foreach(entry ${ARGN})
    string(REGEX MATCH "^([^=]+)=(.+)$" found "${entry}")
    set(name ${CMAKE_MATCH_1})
    set(file ${CMAKE_MATCH_2})
    list(APPEND files ${file})
    if(EMSCRIPTEN) # an assembler of its own
      file(SIZE ${file} size)
      math(EXPR end "${size} + 1")
      string(APPEND text "asm(\".section .rodata.bn_${name},\\\"\\\",@\\n.hidden bn_${name}\\n.globl bn_${name}\\n.p2align 4\\n\"\n"
        "    \".type bn_${name},@object\\nbn_${name}:\\n.incbin \\\"${file}\\\"\\n.int8 0\\n.size bn_${name},${end}\\n.text\");\n"
        "extern \"C\" const char bn_${name}[];\nconst EmbeddedFile ${name} = {bn_${name}, ${size}};\n")
      continue()
    endif()
    string(APPEND text "asm(\".pushsection .rodata\\n.balign 16\\n.hidden bn_${name}\\n.hidden bn_${name}_end\\n\"\n"
      "    \".global bn_${name}\\nbn_${name}:\\n.incbin \\\"${file}\\\"\\n.global bn_${name}_end\\nbn_${name}_end:\\n.byte 0\\n.popsection\");\n"
      "extern \"C\" const char bn_${name}[], bn_${name}_end[];\n"
      "const EmbeddedFile ${name} = {bn_${name}, static_cast<std::size_t>(bn_${name}_end - bn_${name})};\n")
  endforeach()
  file(CONFIGURE OUTPUT ${source} CONTENT "${text}} // namespace burnish\n" @ONLY)
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}")
endfunction()
