# Debian ships OpenCV's CMake package only with libopencv-dev, which drags in every module. Two small packages do, so
# the libraries are found by name: target pyroscene::opencv (core, imgproc). PNG files are written with libpng itself, since
# imgcodecs brings in 30 libraries of other formats, which took a fifth of the program's start.
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(part core imgproc)
  find_library(OPENCV_${part}_LIBRARY opencv_${part} REQUIRED)
  list(APPEND PYROSCENE_OPENCV_LIBRARIES ${OPENCV_${part}_LIBRARY})
endforeach()
add_library(pyroscene_opencv INTERFACE IMPORTED)
add_library(pyroscene::opencv ALIAS pyroscene_opencv)
target_include_directories(pyroscene_opencv SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
target_link_libraries(pyroscene_opencv INTERFACE ${PYROSCENE_OPENCV_LIBRARIES})
