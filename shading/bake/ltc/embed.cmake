# Turns a file into a C++ source of its bytes as words, little-endian: cmake -DOUT=FILE -DTABLE=FILE -DNAME=NAME -P embed.cmake
file(SIZE "${TABLE}" size)
file(READ "${TABLE}" bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u,\n" words "${bytes}")
file(WRITE "${OUT}" "#include \"shading/bake/ltc/shipped.h\"\n\nnamespace burnish::ltc {\n"
  "const std::uint32_t k${NAME}Words[] = {\n${words}};\nconst std::size_t k${NAME}Bytes = ${size};\n} // namespace burnish::ltc\n")
