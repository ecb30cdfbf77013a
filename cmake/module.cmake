# One static library per folder: pyroscene_module(<name> SOURCES ... [PUBLIC module...] [PRIVATE target...]).
# Headers are included as "<folder>/<header>.h" in the tree and after installation (include/pyroscene/<folder>/...).
add_library(pyroscene_options INTERFACE)
target_compile_features(pyroscene_options INTERFACE cxx_std_20)
target_compile_options(pyroscene_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                       -Wnon-virtual-dtor $<$<BOOL:${PYROSCENE_WARNINGS_AS_ERRORS}>:-Werror>)

function(pyroscene_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(pyroscene_${name} STATIC ${ARG_SOURCES})
  add_library(pyroscene::${name} ALIAS pyroscene_${name})
  set_target_properties(pyroscene_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(pyroscene_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/pyroscene>)
  target_link_libraries(pyroscene_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:pyroscene_options>)
  target_compile_features(pyroscene_${name} PUBLIC cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY PYROSCENE_MODULES pyroscene_${name})
endfunction()
