# Generated scenes and environments, the graph, tangents and draw tables. Included by CMakeLists.txt beside it.
target_sources(burnish_core PRIVATE
  ${CMAKE_CURRENT_LIST_DIR}/builtin.cpp
  ${CMAKE_CURRENT_LIST_DIR}/builtin_environments.cpp
  ${CMAKE_CURRENT_LIST_DIR}/builtin_plate.cpp
  ${CMAKE_CURRENT_LIST_DIR}/builtin_spheres.cpp
  ${CMAKE_CURRENT_LIST_DIR}/builtin_surface.cpp
  ${CMAKE_CURRENT_LIST_DIR}/builtin_teapot.cpp
  ${CMAKE_CURRENT_LIST_DIR}/draw_clusters.cpp
  ${CMAKE_CURRENT_LIST_DIR}/draw_tables.cpp
  ${CMAKE_CURRENT_LIST_DIR}/scene.cpp
  ${CMAKE_CURRENT_LIST_DIR}/tangents.cpp)
