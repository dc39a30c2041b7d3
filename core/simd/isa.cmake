# bn_isa_objects(TARGET source.cpp...): compiles each source once for every instruction set and links the objects into TARGET.
# In a source compiled this way BN_ISA is 0 (scalar), 1 (AVX2) or 2 (AVX-512), and core/simd/lanes.h puts the matching lane
# types into namespace BN_ISA_NS; everything else in the program is x86-64-v2.
set(BN_ISA_FLAGS_scalar -march=x86-64-v2)
set(BN_ISA_FLAGS_avx2 -march=x86-64-v3)
set(BN_ISA_FLAGS_avx512 -march=x86-64-v4 -mprefer-vector-width=512)
set(BN_ISA_ID_scalar 0)
set(BN_ISA_ID_avx2 1)
set(BN_ISA_ID_avx512 2)

function(bn_isa_objects target)
  foreach(isa scalar avx2 avx512)
    set(objects ${target}_${isa})
    add_library(${objects} OBJECT ${ARGN})
    set_target_properties(${objects} PROPERTIES BN_ISA ${isa})
    target_compile_definitions(${objects} PRIVATE BN_ISA=${BN_ISA_ID_${isa}})
    target_compile_options(${objects} PRIVATE ${BN_ISA_FLAGS_${isa}})
    target_link_libraries(${objects} PRIVATE burnish_flags)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
