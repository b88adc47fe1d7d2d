#include "capture/manifest_io.h"
#include "capture/stand_folders.h"
#include "fuzz/fuzz.h"

// The same text as a manifest of photographs, as one of patterns, as one of a sphere, as one of the
// light all around, and as a camera's response.
LIVERY_FUZZ(text) {
    using namespace livery;
    const auto parse = [](const auto& one) {
        try {
            one();
        } catch (const FileError&) {
        }
    };
    parse([&] { parse_captures_manifest(text, "/no folder/manifest.json"); });
    parse([&] { parse_patterns_manifest(text, "/no folder/manifest.json"); });
    parse([&] { parse_sphere_manifest(text, "/no folder/manifest.json"); });
    parse([&] { parse_environment_manifest(text, "/no folder/manifest.json"); });
    parse_response(text, "response.json");
}
