# Completion scripts for bash, zsh and fish. The built tool prints them, and they are installed where the shells find them.
if(NOT CAMBER_SANITIZE AND NOT CAMBER_FUZZ AND NOT CMAKE_CROSSCOMPILING)
  set(scripts)
  foreach(shell bash zsh fish)
    set(script ${CMAKE_CURRENT_BINARY_DIR}/completion.${shell})
    add_custom_command(OUTPUT ${script} COMMAND $<TARGET_FILE:camber_tool> --completion ${shell} > ${script}
                       DEPENDS camber_tool VERBATIM)
    list(APPEND scripts ${script})
  endforeach()
  add_custom_target(camber_completion ALL DEPENDS ${scripts})
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/completion.bash RENAME camber
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/completion.zsh RENAME _camber
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/completion.fish RENAME camber.fish
          DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()
