# Installation: libraries, headers under include/pyroscene/<folder>, data under share/pyroscene, the program, and a CMake
# package, so that another project can say find_package(pyroscene) and link pyroscene::<module>.
# tests/consumer is such a project; scripts/check_consumer.sh builds it.
include(CMakePackageConfigHelpers)

set(PYROSCENE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/pyroscene)
set(PYROSCENE_SHARE_DIR ${CMAKE_INSTALL_DATADIR}/pyroscene)

get_property(modules GLOBAL PROPERTY PYROSCENE_MODULES)
install(TARGETS ${modules} EXPORT pyroscene-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(module IN LISTS modules)
  get_target_property(folder ${module} SOURCE_DIR)
  get_filename_component(name ${folder} NAME)
  file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pyroscene/${name})
endforeach()
if(TARGET pyroscene_cli)
  install(TARGETS pyroscene_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

# The program finds its data at ../share/pyroscene, seen from its own folder.
install(DIRECTORY data/ DESTINATION ${PYROSCENE_SHARE_DIR})
foreach(folder specs srf bands)
  if(EXISTS ${PROJECT_SOURCE_DIR}/sensors/${folder})
    install(DIRECTORY sensors/${folder} DESTINATION ${PYROSCENE_SHARE_DIR}/sensors)
  endif()
endforeach()
install(DIRECTORY scenarios DESTINATION ${PYROSCENE_SHARE_DIR} PATTERN bad EXCLUDE)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT pyroscene-targets NAMESPACE pyroscene:: DESTINATION ${PYROSCENE_PACKAGE_DIR})
configure_package_config_file(cmake/pyroscene-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/pyroscene-config.cmake
  INSTALL_DESTINATION ${PYROSCENE_PACKAGE_DIR} PATH_VARS PYROSCENE_SHARE_DIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/pyroscene-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pyroscene-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/pyroscene-config-version.cmake
              cmake/opencv.cmake cmake/openvdb.cmake cmake/hdf4.cmake DESTINATION ${PYROSCENE_PACKAGE_DIR})
