# README.md shows pick_own_mesh.cpp as it stands here.
file(READ ${CMAKE_CURRENT_LIST_DIR}/../../README.md readme)
file(READ ${CMAKE_CURRENT_LIST_DIR}/pick_own_mesh.cpp example)
string(FIND "${readme}" "```cpp\n${example}```" place)
if(place EQUAL -1)
    message(FATAL_ERROR "README.md doesn't show tests/package/pick_own_mesh.cpp as it is")
endif()
