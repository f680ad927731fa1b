# Compiles files of schemas/ and config/profiles into the library, so that it needs none of them at run time.
#
#   include(morphbake-embed)
#   morphbake_embed(morphbake schemas schemas/recipe.schema.json ...)
#
# makes them what embedded_schemas() returns. Run as a script (-DKIND=schemas -DOUTPUT= -DFILES=a|b) it writes the source file; as a command of the build it does
# so whenever one of the files has changed.
if(CMAKE_SCRIPT_MODE_FILE)
  cmake_minimum_required(VERSION 3.25)
  set(source "#include \"morphbake/json/embedded.h\"\n\nnamespace morphbake {\nnamespace {\n\n")
  string(APPEND source "constexpr EmbeddedFile files[] = {\n")
  string(REPLACE "|" ";" files "${FILES}")
  foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" text)
    string(APPEND source "{\"${name}\", R\"embedded(${text})embedded\"},\n")
  endforeach()
  string(APPEND source "};\n\n}  // namespace\n\n"
         "std::span<const EmbeddedFile> embedded_${KIND}() { return files; }\n\n"
         "}  // namespace morphbake\n")
  file(WRITE "${OUTPUT}" "${source}")
  return()
endif()

set(MORPHBAKE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(morphbake_embed target kind)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_${kind}.cpp)
  string(REPLACE ";" "|" files "${ARGN}")
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DKIND=${kind} -DOUTPUT=${output} "-DFILES=${files}" -P ${MORPHBAKE_EMBED_SCRIPT}
    DEPENDS ${ARGN} ${MORPHBAKE_EMBED_SCRIPT}
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
