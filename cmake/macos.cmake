# macOS, with zig's C++ compiler (PyPI: ziglang), which brings headers and libraries of all systems. Programs are linked and
# cannot be run here. MULTIRES_ZIG: the zig program; MULTIRES_ZIG_TARGET: aarch64-macos or x86_64-macos.
set(MULTIRES_ZIG zig CACHE FILEPATH "The program zig")
set(MULTIRES_ZIG_TARGET aarch64-macos CACHE STRING "What zig compiles for")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES MULTIRES_ZIG MULTIRES_ZIG_TARGET)
set(CMAKE_SYSTEM_NAME Darwin)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR "${MULTIRES_ZIG_TARGET}")
set(CMAKE_OSX_SYSROOT "")
set(CMAKE_OSX_DEPLOYMENT_TARGET "")

# CMake calls programs without arguments of their own.
set(wrappers "${CMAKE_BINARY_DIR}/zig")
foreach(tool c++ ar ranlib)
  set(options "")
  if(tool STREQUAL "c++")
    set(options "-target ${MULTIRES_ZIG_TARGET}")
  endif()
  file(WRITE "${wrappers}/${tool}" "#!/bin/sh\nexec '${MULTIRES_ZIG}' ${tool} ${options} \"$@\"\n")
  file(CHMOD "${wrappers}/${tool}" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
endforeach()
set(CMAKE_CXX_COMPILER "${wrappers}/c++")
set(CMAKE_AR "${wrappers}/ar" CACHE FILEPATH "")
set(CMAKE_RANLIB "${wrappers}/ranlib" CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
