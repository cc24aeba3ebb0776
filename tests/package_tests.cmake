# The installed package: a foreign project finds, links and uses it. Not with sanitizers: then who
# links the libraries needs the same ones.
if(NOT RAYPICK_SANITIZE)
    add_test(NAME package
        COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR}
                -DWORK=${CMAKE_CURRENT_BINARY_DIR}/package
                -P ${CMAKE_CURRENT_SOURCE_DIR}/package/check.cmake)
    set_tests_properties(package PROPERTIES LABELS cpu TIMEOUT 300)
endif()
add_test(NAME readme
    COMMAND ${CMAKE_COMMAND} -P ${CMAKE_CURRENT_SOURCE_DIR}/package/check_readme.cmake)
set_tests_properties(readme PROPERTIES LABELS cpu)
