// How long a scan of a million triangles takes to load, from a file in memory to a mesh that can
// be drawn: whole ones, and ones that need every repair.
#include <benchmark/benchmark.h>

#include "core/random.h"
#include "mesh/scan_writer.h"

namespace livery {
namespace {

enum class Format { ascii_ply, little_endian_ply, big_endian_ply, obj };
enum class State { whole, no_normals, damaged };

/// 1.0 million triangles. `damaged`: a soup without normals, each second triangle the wrong way.
ScanWriter million_triangles(State state) {
    ScanWriter scan = sphere_scan(501);
    if (state == State::whole) return scan;
    scan.normals.clear();
    if (state == State::no_normals) return scan;
    ScanWriter soup;
    for (std::size_t k = 0; k < scan.faces.size(); ++k) {
        auto& face = soup.faces.emplace_back();
        for (const int corner : scan.faces[k]) {
            face.push_back(static_cast<int>(soup.positions.size()));
            soup.positions.push_back(scan.positions[static_cast<std::size_t>(corner)]);
        }
        if (k % 2 == 1) std::swap(face[0], face[1]);
    }
    return soup;
}

std::string bytes_of(const ScanWriter& scan, Format format) {
    switch (format) {
        case Format::ascii_ply:
            return scan.ascii_ply();
        case Format::little_endian_ply:
            return scan.binary_ply(std::endian::little);
        case Format::big_endian_ply:
            return scan.binary_ply(std::endian::big);
        case Format::obj:
            break;
    }
    return scan.obj();
}

void load(benchmark::State& run, Format format, State state) {
    const std::string bytes = bytes_of(million_triangles(state), format);
    std::size_t triangles = 0;
    for ([[maybe_unused]] auto _ : run) {
        const Mesh mesh = read_mesh(bytes, format == Format::obj ? "scan.obj" : "scan.ply");
        triangles = mesh.triangles.size();
    }
    run.counters["triangles"] = static_cast<double>(triangles);
    run.counters["bytes"] = static_cast<double>(bytes.size());
}

void add(const char* name, Format format, State state) {
    benchmark::RegisterBenchmark(name, load, format, state)
        ->Unit(benchmark::kMillisecond)
        ->MinTime(2.0);
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    using livery::Format;
    using livery::State;
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    livery::add("ply ascii", Format::ascii_ply, State::whole);
    livery::add("ply little endian", Format::little_endian_ply, State::whole);
    livery::add("ply big endian", Format::big_endian_ply, State::whole);
    livery::add("obj", Format::obj, State::whole);
    livery::add("ply ascii, no normals", Format::ascii_ply, State::no_normals);
    livery::add("ply ascii, damaged soup", Format::ascii_ply, State::damaged);
    livery::add("obj, damaged soup", Format::obj, State::damaged);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
