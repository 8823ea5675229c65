# pages_test.cmake - the examples of docs/worlds.md and docs/recordings.md build against the installed package and run,
# and what one prints is what the page says.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
set(docs ${CMAKE_CURRENT_LIST_DIR}/../../docs)
set(project ${SCRATCH}/pages)
file(REMOVE_RECURSE ${project})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/pages/main.cpp DESTINATION ${project})

take_examples(${docs}/worlds.md 3 ${project})
take_examples(${docs}/recordings.md 3 ${project})

file(WRITE ${project}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(Pages LANGUAGES CXX)
find_package(Tandem 0.1 REQUIRED)
add_executable(pages main.cpp)
target_link_libraries(pages PRIVATE Tandem::tandem)
")
configure(${project} ${project}/build)
step(${CMAKE_COMMAND} --build ${project}/build)
run(${project}/build/pages printed)
string(REGEX REPLACE "^[a-z_]+: " "" printed "${printed}") # the call
string(STRIP "${printed}" printed)
must_show(${docs}/worlds.md "what its first example prints" "// InputError: ${printed}\n")
