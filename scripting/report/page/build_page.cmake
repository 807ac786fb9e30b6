# Makes report_page.html and view_page.html (the workbench) in the build folder: cmake -DSOURCE=scripting/report/page -DWORK=FOLDER -DOUTPUT=FILE -DVIEW_OUTPUT=FILE -DNPM=... -DNODE=... -P build_page.cmake
# If a page cannot be built (no network and no npm cache, or a node that is too old), the file is empty and the reason is printed. All other targets are built.
# The source tree stays unchanged: the sources are copied, and the libraries are installed beside the copies.

function(give_up why details)
  message("warning: the report page is not built in: ${why}")
  message("${details}")
  message("  sterna is built without report{}. Run cmake again to repeat the attempt.")
  file(WRITE ${OUTPUT} "")
  file(WRITE ${VIEW_OUTPUT} "")
endfunction()

file(REMOVE_RECURSE ${WORK}/src)
file(COPY ${SOURCE}/src ${SOURCE}/build.mjs ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${WORK})

# Libraries are installed again only if their list has changed.
file(SHA256 ${WORK}/package-lock.json lock)
set(stamp ${WORK}/node_modules/.sterna_lock)
set(installed "")
if(EXISTS ${stamp})
  file(READ ${stamp} installed)
endif()
if(NOT installed STREQUAL lock)
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 --fetch-timeout=30000
                  WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    give_up("npm ci failed; it requires access to the npm registry" "${said}")
    return()
  endif()
  file(WRITE ${stamp} ${lock})
endif()

execute_process(COMMAND ${NODE} ${WORK}/build.mjs ${OUTPUT} ${VIEW_OUTPUT} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT status EQUAL 0)
  execute_process(COMMAND ${NODE} --version OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(version VERSION_LESS "v18")
    give_up("node ${version} is too old; 18 or later is required" "${said}")
    return()
  endif()
  message(FATAL_ERROR "the report page could not be bundled:\n${said}")  # an error in the sources of the page
endif()
