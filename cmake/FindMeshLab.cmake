# Makes a MeshLab source tree, and where there is one the library built from it, usable for plugins.
#
# Input (cache or -D):
#   MESHLAB_SOURCE_DIR       root of a MeshLab source tree with vcglib in it (holds ML_VERSION)
#   MESHLAB_COMMON_LIBRARY   its libmeshlab-common.so, libmeshlab-common.dylib or, the import library, meshlab-common.lib.
#                            Not given: an installed one is looked for. Empty: plugins are linked without it and find
#                            its symbols in the process that loads them, which Windows does not have.
#   MESHLAB_SCALAR           float or double, as that library was built; a plugin of the other kind is refused by it
#
# Output:
#   MeshLab::Common          headers, defines and library for a plugin
#   MeshLab::vcglib          vcglib's headers alone
#   MeshLab_VERSION          "2020.09", ...
#   MESHLAB_API              2020 (MeshFilterInterface) or 2022 (FilterPlugin: 2022.02 and later)
#   MESHLAB_HOST             "pymeshlab-2025.07", "meshlab-2020.09-float", ...: for whom plugins are
#   MESHLAB_PLUGIN_DIR       where that MeshLab looks for plugins, relative to the install prefix

set(MESHLAB_SCALAR float CACHE STRING "Scalar type that MeshLab was built with: float or double")
set_property(CACHE MESHLAB_SCALAR PROPERTY STRINGS float double)
if(NOT DEFINED MESHLAB_COMMON_LIBRARY)
  find_library(MESHLAB_COMMON_LIBRARY meshlab-common PATH_SUFFIXES meshlab DOC "MeshLab's library, or empty")
endif()

# The interface's header tells the two APIs apart, also in trees between the releases.
set(MESHLAB_API "")
set(MeshLab_VERSION "")
if(EXISTS "${MESHLAB_SOURCE_DIR}/src/common/plugins/interfaces/filter_plugin.h")
  set(MESHLAB_API 2022)
elseif(EXISTS "${MESHLAB_SOURCE_DIR}/src/common/interfaces.h")
  set(MESHLAB_API 2020)
endif()
if(EXISTS "${MESHLAB_SOURCE_DIR}/ML_VERSION")
  file(STRINGS "${MESHLAB_SOURCE_DIR}/ML_VERSION" MeshLab_VERSION LIMIT_COUNT 1)
endif()
find_path(MESHLAB_VCGLIB_DIR vcg/complex/complex.h
  PATHS "${MESHLAB_SOURCE_DIR}/src/vcglib" "${MESHLAB_SOURCE_DIR}/vcglib" NO_DEFAULT_PATH)
mark_as_advanced(MESHLAB_VCGLIB_DIR)

set(meshlab_library_ok TRUE)
if(MESHLAB_COMMON_LIBRARY AND NOT EXISTS "${MESHLAB_COMMON_LIBRARY}")
  set(meshlab_library_ok FALSE)
endif()
if(WIN32 AND NOT MESHLAB_COMMON_LIBRARY)
  message(FATAL_ERROR "On Windows plugins are linked with meshlab-common.lib: set MESHLAB_COMMON_LIBRARY to it.")
endif()
if(NOT MESHLAB_SCALAR MATCHES "^(float|double)$")
  message(FATAL_ERROR "MESHLAB_SCALAR is '${MESHLAB_SCALAR}', must be float or double")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MeshLab
  REQUIRED_VARS MESHLAB_API MeshLab_VERSION MESHLAB_VCGLIB_DIR meshlab_library_ok
  VERSION_VAR MeshLab_VERSION
  REASON_FAILURE_MESSAGE "MESHLAB_SOURCE_DIR is '${MESHLAB_SOURCE_DIR}' (run scripts/setup.sh for the presets), \
MESHLAB_COMMON_LIBRARY is '${MESHLAB_COMMON_LIBRARY}'")
if(NOT MeshLab_FOUND OR TARGET MeshLab::Common)
  return()
endif()

# A double build calls itself "2025.07d", and a plugin must say the same.
set(meshlab_own_version "${MeshLab_VERSION}")
set(meshlab_precision fp)
if(MESHLAB_SCALAR STREQUAL "double")
  string(APPEND meshlab_own_version "d")
  set(meshlab_precision dp)
endif()

set(MESHLAB_HOST meshlab-${MeshLab_VERSION}-${MESHLAB_SCALAR})
if(MESHLAB_COMMON_LIBRARY MATCHES "pymeshlab")
  set(MESHLAB_HOST pymeshlab-${MeshLab_VERSION})
  # load_plugin() takes any path: straight into the prefix.
  set(MESHLAB_PLUGIN_DIR ".")
elseif(MESHLAB_API EQUAL 2020)
  # Beside its library, as in /usr/lib/x86_64-linux-gnu/meshlab/plugins.
  set(MESHLAB_PLUGIN_DIR "lib/meshlab/plugins")
  if(MESHLAB_COMMON_LIBRARY MATCHES "/(lib/.*)/[^/]*$")
    set(MESHLAB_PLUGIN_DIR "${CMAKE_MATCH_1}/plugins")
  endif()
else()
  # The GUI's folder for the user's own plugins, with the prefix at ~/.local.
  math(EXPR bits "8 * ${CMAKE_SIZEOF_VOID_P}")
  set(MESHLAB_PLUGIN_DIR
    "share/VCG/MeshLab_${bits}bit_${meshlab_precision}/MeshLabExtraPlugins/${meshlab_own_version}")
endif()

find_package(Qt5 5.9 REQUIRED COMPONENTS Core Gui Widgets OpenGL Xml Network)
find_package(OpenGL REQUIRED)
find_package(GLEW REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)

add_library(MeshLab::vcglib INTERFACE IMPORTED)
target_include_directories(MeshLab::vcglib SYSTEM INTERFACE "${MESHLAB_VCGLIB_DIR}")
target_link_libraries(MeshLab::vcglib INTERFACE Eigen3::Eigen)

add_library(MeshLab::Common INTERFACE IMPORTED)
target_include_directories(MeshLab::Common SYSTEM INTERFACE "${MESHLAB_SOURCE_DIR}/src" ${GLEW_INCLUDE_DIRS})
target_compile_definitions(MeshLab::Common INTERFACE
  MESHLAB_VERSION=${meshlab_own_version} MESHLAB_SCALAR=${MESHLAB_SCALAR})
target_link_libraries(MeshLab::Common INTERFACE
  MeshLab::vcglib Qt5::Core Qt5::Gui Qt5::Widgets Qt5::OpenGL Qt5::Xml Qt5::Network)
if(MESHLAB_COMMON_LIBRARY)
  target_link_libraries(MeshLab::Common INTERFACE "${MESHLAB_COMMON_LIBRARY}")
endif()
