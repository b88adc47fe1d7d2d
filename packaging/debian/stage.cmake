# Run by CPack on the installed tree, before it becomes a package: what Debian wants otherwise.
cmake_minimum_required(VERSION 3.25)

set(share ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share)
set(doc ${share}/doc/livery)

function(compress file)
    execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

compress(${share}/man/man1/livery.1)
# Its newest entry is of the package that this is.
file(READ ${CMAKE_CURRENT_LIST_DIR}/changelog changelog)
string(REGEX REPLACE "^livery \\([^)]+\\) unstable;"
    "livery (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) ${CPACK_LIVERY_SUITE};"
    changelog "${changelog}")
file(WRITE ${doc}/changelog.Debian "${changelog}")
compress(${doc}/changelog.Debian)
file(RENAME ${doc}/CHANGELOG.md ${doc}/changelog)
compress(${doc}/changelog)
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
