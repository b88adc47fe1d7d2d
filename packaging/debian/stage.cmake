# Run by CPack on the installed tree, before it becomes a package: what Debian wants otherwise.
cmake_minimum_required(VERSION 3.25)

set(share ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share)
set(doc ${share}/doc/livery)

function(compress file)
    execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

compress(${share}/man/man1/livery.1)
configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog ${doc}/changelog.Debian COPYONLY)
compress(${doc}/changelog.Debian)
# The licence is in the copyright file.
configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright ${doc}/copyright COPYONLY)
file(REMOVE ${doc}/LICENSE)

# Fonts are a package of their own.
file(GLOB fonts ${share}/livery/fonts/*)
foreach(font ${fonts})
    get_filename_component(name ${font} NAME)
    set(packaged /usr/share/fonts/opentype/inter/${name})
    if(NOT EXISTS ${packaged})
        message(FATAL_ERROR "${name}: expected it in ${packaged}, of fonts-inter")
    endif()
    file(REMOVE ${font})
    file(CREATE_LINK ../../fonts/opentype/inter/${name} ${font} SYMBOLIC)
endforeach()
