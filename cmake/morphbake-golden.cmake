# Golden files of recipes as tests of CTest.
#
#   find_package(morphbake REQUIRED)
#   enable_testing()
#   morphbake_add_golden(recipes/nose.json)
#   morphbake_add_golden(recipes/tail.json NAME tail GOLDEN_DIR accepted ARGUMENTS --relative 1e-4)
#
# adds a test golden.<name of the recipe's file> that runs `morphbake golden`: it bakes the recipe and
# compares each output with the file of its name in GOLDEN_DIR, "golden" beside the recipe where that is
# not given. Evidence of differences and the verdict as JUnit's XML go to golden-differences/ in the build
# folder. Nothing is stored by a test: run `morphbake golden RECIPE --accept` for that.
#
# The program is ${morphbake_EXECUTABLE}: that of the package, unless it is set before.
function(morphbake_add_golden recipe)
  cmake_parse_arguments(PARSE_ARGV 1 golden "" "NAME;GOLDEN_DIR" "ARGUMENTS")
  if(golden_UNPARSED_ARGUMENTS OR golden_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "morphbake_add_golden(${recipe}): cannot understand ${golden_UNPARSED_ARGUMENTS} "
                        "${golden_KEYWORDS_MISSING_VALUES}; it takes NAME, GOLDEN_DIR and ARGUMENTS")
  endif()
  get_filename_component(file ${recipe} ABSOLUTE)
  if(NOT EXISTS ${file})
    message(FATAL_ERROR "morphbake_add_golden(${recipe}): there is no ${file}")
  endif()
  if(NOT golden_NAME)
    get_filename_component(golden_NAME ${recipe} NAME_WE)
  endif()
  set(options "")
  if(golden_GOLDEN_DIR)
    get_filename_component(folder ${golden_GOLDEN_DIR} ABSOLUTE)
    list(APPEND options --golden-dir ${folder})
  endif()
  set(evidence ${CMAKE_CURRENT_BINARY_DIR}/golden-differences/${golden_NAME})
  add_test(NAME golden.${golden_NAME}
           COMMAND ${morphbake_EXECUTABLE} golden ${file} ${options} --evidence-dir ${evidence} --junit
                   ${evidence}/junit.xml ${golden_ARGUMENTS})
  set_tests_properties(golden.${golden_NAME} PROPERTIES LABELS golden)
endfunction()
