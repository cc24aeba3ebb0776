# Installs raypick into an empty folder, builds this foreign project with it and runs its programs.
#   cmake -DBUILD=<raypick's build> -DWORK=<folder to use> -P check.cmake
function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/pick_own_mesh)
run(${WORK}/build/pick_on_threads)
run(${WORK}/build/list_objects ${WORK}/prefix/share/raypick/default.json)
if(EXISTS ${WORK}/prefix/bin/raypick)
    run(${WORK}/prefix/bin/raypick --version)
endif()
