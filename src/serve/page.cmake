# Embeds the page of camber serve, and Leaflet, which shows the map. Included by src/CMakeLists.txt: `page_sources` is
# the C file that the build makes. Run as a script (-P), it writes that file to OUT; FILES is a list of the form
# name|path|name|path...
#
# Leaflet is Debian's libjs-leaflet or npm's leaflet; this tree contains no part of it. It is embedded together with its
# licence (BSD, two clauses) or not at all. Without it the page shows one picture and says what to install.
if(CMAKE_SCRIPT_MODE_FILE)
  set(type_html "text/html; charset=utf-8")
  set(type_css "text/css; charset=utf-8")
  set(type_js "text/javascript; charset=utf-8")
  set(type_svg "image/svg+xml")
  set(type_txt "text/plain; charset=utf-8")
  string(REPLACE "|" ";" FILES "${FILES}")
  set(arrays "")
  set(table "")
  set(count 0)
  while(FILES)
    list(POP_FRONT FILES name path)
    string(REGEX MATCH "[a-z]+$" ending "${name}")
    if(name STREQUAL "index.html")
      set(name "") # the page itself
    endif()
    file(READ "${path}" bytes HEX)
    string(REGEX REPLACE "(................................................)" "\\1\n" bytes "${bytes}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
    string(APPEND arrays "static const unsigned char file_${count}[] = {\n${bytes}\n};\n")
    string(APPEND table "    {\"${name}\", \"${type_${ending}}\", file_${count}, sizeof file_${count}},\n")
    math(EXPR count "${count} + 1")
  endwhile()
  file(WRITE "${OUT}" "#include \"serve/page.h\"\n${arrays}const camber_page_file camber_page_files[] = {\n${table}};\n"
       "const size_t camber_page_file_count = ${count};\n")
  return()
endif()

find_path(CAMBER_LEAFLET leaflet.css
          PATHS /usr/share/javascript/leaflet ${CMAKE_BINARY_DIR}/npm/node_modules/leaflet/dist NO_DEFAULT_PATH
          DOC "Folder of Leaflet's leaflet.css and leaflet.js")
# In Debian, leaflet.js is the unminified file; in npm's package, leaflet.js is the minified one.
find_file(CAMBER_LEAFLET_SCRIPT NAMES leaflet.min.js leaflet.js PATHS ${CAMBER_LEAFLET} NO_DEFAULT_PATH)
find_file(CAMBER_LEAFLET_LICENSE NAMES LICENSE copyright
          PATHS ${CAMBER_LEAFLET}/.. /usr/share/doc/libjs-leaflet NO_DEFAULT_PATH)
mark_as_advanced(CAMBER_LEAFLET_SCRIPT CAMBER_LEAFLET_LICENSE)

set(page_files)
set(page_inputs)
foreach(name index.html page.css page.js icon.svg)
  list(APPEND page_files ${name} ${CMAKE_CURRENT_LIST_DIR}/page/${name})
  list(APPEND page_inputs ${CMAKE_CURRENT_LIST_DIR}/page/${name})
endforeach()
if(CAMBER_LEAFLET AND CAMBER_LEAFLET_SCRIPT AND CAMBER_LEAFLET_LICENSE)
  list(APPEND page_files leaflet.css ${CAMBER_LEAFLET}/leaflet.css leaflet.js ${CAMBER_LEAFLET_SCRIPT}
       leaflet-LICENSE.txt ${CAMBER_LEAFLET_LICENSE})
  list(APPEND page_inputs ${CAMBER_LEAFLET}/leaflet.css ${CAMBER_LEAFLET_SCRIPT} ${CAMBER_LEAFLET_LICENSE})
else()
  message(STATUS "camber: no Leaflet (Debian: libjs-leaflet): the page of serve shows one picture")
endif()
set(page_sources ${CMAKE_CURRENT_BINARY_DIR}/camber_page.c)
list(JOIN page_files "|" page_files)
add_custom_command(OUTPUT ${page_sources}
  COMMAND ${CMAKE_COMMAND} -DOUT=${page_sources} "-DFILES=${page_files}" -P ${CMAKE_CURRENT_LIST_FILE}
  DEPENDS ${page_inputs} ${CMAKE_CURRENT_LIST_FILE} VERBATIM)
