# SPDX-License-Identifier: MIT OR Apache-2.0
#
# Robot dynamics as generated C, in a project that CMake (3.16 or later) builds. See
# docs/embedded.md.
#
#   find_package(articulated REQUIRED COMPONENTS eigen)
#   articulated_generate(TARGET arm FILE robots/arm.urdf FUNCTIONS inverse_dynamics mass_matrix)
#   target_link_libraries(controller PRIVATE arm articulated::eigen)
#
# The component `eigen` needs Eigen 3.3 or later. It is the target `articulated::eigen`, with the
# header <articulated/eigen.hpp>.
#
# The command `articulated` is needed by `articulated_generate` alone. The variable
# ARTICULATED_COMMAND, of CMake or of the environment, has its path; without it the command is
# searched for.

if(NOT ARTICULATED_COMMAND AND DEFINED ENV{ARTICULATED_COMMAND})
  set(ARTICULATED_COMMAND "$ENV{ARTICULATED_COMMAND}" CACHE FILEPATH "The command `articulated`" FORCE)
endif()
# It runs on this machine, also where the project is for another one.
find_program(ARTICULATED_COMMAND articulated
  HINTS "$ENV{CARGO_HOME}/bin" "$ENV{HOME}/.cargo/bin" "$ENV{USERPROFILE}/.cargo/bin"
  DOC "The command `articulated`" NO_CMAKE_FIND_ROOT_PATH)

foreach(_articulated_component IN LISTS articulated_FIND_COMPONENTS)
  set(articulated_${_articulated_component}_FOUND FALSE)
  if(_articulated_component STREQUAL "eigen")
    # Eigen 5 does not count as a version of 3.
    find_package(Eigen3 QUIET CONFIG)
    if(TARGET Eigen3::Eigen AND NOT Eigen3_VERSION VERSION_LESS 3.3)
      set(articulated_eigen_FOUND TRUE)
    else()
      set(_articulated_complaint "component eigen: Eigen 3.3 or later was not found (Debian: libeigen3-dev)")
    endif()
  else()
    set(_articulated_complaint "found the component \"${_articulated_component}\", expected eigen")
  endif()
  if(articulated_FIND_REQUIRED_${_articulated_component} AND NOT articulated_${_articulated_component}_FOUND)
    set(articulated_FOUND FALSE)
    set(articulated_NOT_FOUND_MESSAGE "${_articulated_complaint}")
  endif()
endforeach()
unset(_articulated_component)
unset(_articulated_complaint)

if(articulated_eigen_FOUND AND NOT TARGET articulated::eigen)
  # The header is beside this file in the source, and in `include` of the prefix once installed.
  set(_articulated_include "${CMAKE_CURRENT_LIST_DIR}/include")
  if(NOT EXISTS "${_articulated_include}/articulated/eigen.hpp")
    get_filename_component(_articulated_include "${CMAKE_CURRENT_LIST_DIR}/../../../include" ABSOLUTE)
  endif()
  add_library(articulated::eigen INTERFACE IMPORTED)
  set_target_properties(articulated::eigen PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${_articulated_include}" INTERFACE_COMPILE_FEATURES cxx_std_14 INTERFACE_LINK_LIBRARIES Eigen3::Eigen)
  unset(_articulated_include)
endif()

# articulated_generate(TARGET <name> FILE <robot> FUNCTIONS <function>... [PREFIX <prefix>]
#                      [STATIC | SHARED] [OPTIONS <word>...] [DEPENDS <file>...])
#
# A library of generated C for one robot. The build runs `articulated generate`, again where the
# robot's file, a file of DEPENDS or the command has changed.
#
#   TARGET     The library. Without STATIC and SHARED it is an INTERFACE library: one header, with
#              static inline functions.
#   FILE       The path of a robot's file (URDF, xacro, MJCF, SDF) or scene, relative to the current
#              source folder; or a bundled robot's name, which has no dot and no slash.
#   FUNCTIONS  Names, groups and requests: inverse_dynamics "pull = vjp(inverse_dynamics, q v)".
#   PREFIX     Names in C begin with it, and the header is <prefix>.h. Default: the target's name.
#   STATIC     A compiled library, with declarations in the header. So is SHARED. The project
#              enables the language C.
#   OPTIONS    Other words for the command: --level f32 --no-libm --frames tool.
#   DEPENDS    Other files that the robot's file includes (xacro, MJCF), or the robot of a scene.
#              The command does not list them.
function(articulated_generate)
  cmake_parse_arguments(PARSE_ARGV 0 given "STATIC;SHARED" "TARGET;FILE;PREFIX" "FUNCTIONS;OPTIONS;DEPENDS")
  if(DEFINED given_UNPARSED_ARGUMENTS)
    list(GET given_UNPARSED_ARGUMENTS 0 first)
    message(FATAL_ERROR "articulated_generate: unknown argument \"${first}\", expected TARGET, FILE, FUNCTIONS, PREFIX, "
      "STATIC, SHARED, OPTIONS or DEPENDS before it")
  endif()
  foreach(keyword TARGET FILE FUNCTIONS)
    if(NOT given_${keyword})
      message(FATAL_ERROR "articulated_generate: expected ${keyword} with a value")
    endif()
  endforeach()
  # OPTIONS and DEPENDS may be empty lists.
  if("PREFIX" IN_LIST given_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "articulated_generate: expected PREFIX with a value, or no PREFIX")
  endif()
  if(given_STATIC AND given_SHARED)
    message(FATAL_ERROR "articulated_generate: found STATIC and SHARED, expected one of them at most")
  endif()
  foreach(word --prefix --functions --output -o --language)
    if(word IN_LIST given_OPTIONS)
      message(FATAL_ERROR "articulated_generate: found ${word} in OPTIONS, expected PREFIX, FUNCTIONS and TARGET for the prefix, "
        "the functions and the file; the language is C")
    endif()
  endforeach()
  if(NOT given_PREFIX)
    set(given_PREFIX "${given_TARGET}")
  endif()
  if(NOT given_PREFIX MATCHES "^[A-Za-z][A-Za-z0-9_]*$")
    message(FATAL_ERROR "articulated_generate: names in C would begin with \"${given_PREFIX}\", expected a letter, then letters, "
      "digits and _: give PREFIX")
  endif()
  if(NOT ARTICULATED_COMMAND OR NOT EXISTS "${ARTICULATED_COMMAND}")
    message(FATAL_ERROR "articulated_generate: the command `articulated` was not found (ARTICULATED_COMMAND is "
      "\"${ARTICULATED_COMMAND}\"). Install it from a clone of its repository by `cargo install --path cli`, or by "
      "`pip install ./python`, or set ARTICULATED_COMMAND to its path.")
  endif()

  set(robot "${given_FILE}")
  set(depends ${given_DEPENDS} "${ARTICULATED_COMMAND}")
  if(given_FILE MATCHES "[./\\]")
    get_filename_component(robot "${given_FILE}" ABSOLUTE)
    get_source_file_property(is_generated "${robot}" GENERATED)
    if(NOT is_generated AND NOT EXISTS "${robot}")
      message(FATAL_ERROR "articulated_generate: FILE: there is no file \"${robot}\", expected a robot's file or a bundled robot's name")
    endif()
    list(APPEND depends "${robot}")
  endif()

  set(folder "${CMAKE_CURRENT_BINARY_DIR}/articulated/${given_TARGET}")
  set(header "${folder}/${given_PREFIX}.h")
  set(output "${header}")
  set(files "${header}")
  if(given_STATIC OR given_SHARED)
    set(output "${folder}")
    list(APPEND files "${folder}/${given_PREFIX}.c")
  endif()
  list(JOIN given_FUNCTIONS "," functions)
  file(MAKE_DIRECTORY "${folder}")
  add_custom_command(OUTPUT ${files}
    COMMAND "${ARTICULATED_COMMAND}" generate "${robot}" --language c --prefix "${given_PREFIX}" --functions "${functions}"
      ${given_OPTIONS} -o "${output}"
    DEPENDS ${depends}
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
    COMMENT "Generating ${given_PREFIX}.h of ${given_FILE}"
    VERBATIM)

  set(visibility PUBLIC)
  if(given_STATIC OR given_SHARED)
    get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
    if(NOT "C" IN_LIST languages)
      message(FATAL_ERROR "articulated_generate: STATIC and SHARED compile C, expected the language C in project()")
    endif()
    set(kind STATIC)
    if(given_SHARED)
      set(kind SHARED)
    endif()
    add_library("${given_TARGET}" ${kind} ${files})
    set_target_properties("${given_TARGET}" PROPERTIES C_STANDARD 99 WINDOWS_EXPORT_ALL_SYMBOLS ON)
  else()
    set(visibility INTERFACE)
    add_library("${given_TARGET}" INTERFACE)
    add_custom_target("${given_TARGET}_header" DEPENDS "${header}")
    add_dependencies("${given_TARGET}" "${given_TARGET}_header")
  endif()
  target_include_directories("${given_TARGET}" ${visibility} "${folder}")
  if(UNIX AND NOT "--no-libm" IN_LIST given_OPTIONS)
    target_link_libraries("${given_TARGET}" ${visibility} m)
  endif()
endfunction()
