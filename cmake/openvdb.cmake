# OpenVDB is optional: without it `pyroscene export --format vdb` says so. Debian ships only a find module that asks for far more
# than is used here, so the library is found by name: target pyroscene::openvdb when it is there.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OPENVDB_LIBRARY openvdb)
find_path(OPENVDB_HALF_INCLUDE_DIR half.h PATH_SUFFIXES Imath OpenEXR)
find_library(OPENVDB_HALF_LIBRARY NAMES Imath Imath-3_1 Imath-3_2)
find_path(OPENVDB_BOOST_INCLUDE_DIR boost/uuid/uuid.hpp)
if(OPENVDB_INCLUDE_DIR AND OPENVDB_LIBRARY AND OPENVDB_HALF_INCLUDE_DIR AND OPENVDB_HALF_LIBRARY AND
   OPENVDB_BOOST_INCLUDE_DIR)
  add_library(pyroscene_openvdb INTERFACE IMPORTED)
  add_library(pyroscene::openvdb ALIAS pyroscene_openvdb)
  target_include_directories(pyroscene_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE_DIR} ${OPENVDB_HALF_INCLUDE_DIR})
  target_link_libraries(pyroscene_openvdb INTERFACE ${OPENVDB_LIBRARY} ${OPENVDB_HALF_LIBRARY} TBB::tbb)
else()
  message(STATUS "OpenVDB not found (libopenvdb-dev): flames cannot be exported as .vdb")
endif()
