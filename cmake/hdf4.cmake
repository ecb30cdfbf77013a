# HDF4 has no CMake package in Debian: target pyroscene::hdf4. libgdal-dev brings the build without netCDF's names along
# (libhdf4-alt-dev).
find_path(HDF4_INCLUDE_DIR hdf/mfhdf.h REQUIRED)
find_library(HDF4_SD_LIBRARY NAMES mfhdfalt mfhdf REQUIRED)
find_library(HDF4_BASE_LIBRARY NAMES dfalt df REQUIRED)
add_library(pyroscene_hdf4 INTERFACE IMPORTED)
add_library(pyroscene::hdf4 ALIAS pyroscene_hdf4)
target_include_directories(pyroscene_hdf4 SYSTEM INTERFACE ${HDF4_INCLUDE_DIR} ${HDF4_INCLUDE_DIR}/hdf)
target_link_libraries(pyroscene_hdf4 INTERFACE ${HDF4_SD_LIBRARY} ${HDF4_BASE_LIBRARY})
