#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include <poll.h>
#include <unistd.h>

#include "capture/camera_messages.h"
#include "core/json.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kWho = "livery-camera";
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30u;

constexpr std::array<const char*, 5> kKinds = {"list", "state", "set", "photograph", "live view"};
constexpr std::array<const char*, 6> kTroubles = {
    "gone", "silent", "held", "card full", "refused", "unusable"};

template <typename Names>
std::size_t number_of(const JsonReader& field, const Names& names) {
    const auto found = std::find(names.begin(), names.end(), field.text());
    if (found == names.end()) field.fail(field.found(), "a word that both know");
    return static_cast<std::size_t>(found - names.begin());
}

Json json_of(const CameraSetting& setting) {
    return {{"name", setting.name},
            {"value", setting.value},
            {"choices", setting.choices},
            {"can_be_set", setting.can_be_set}};
}

CameraSetting setting_in(const JsonReader& reader) {
    CameraSetting setting;
    setting.name = reader["name"].text();
    setting.value = reader["value"].text();
    for (std::size_t k = 0; k < reader["choices"].size(); ++k)
        setting.choices.push_back(reader["choices"].at(k).text());
    setting.can_be_set = reader["can_be_set"].boolean();
    return setting;
}

/// Whole, or not at all.
bool transfer(ssize_t (*once)(int, void*, std::size_t),
              int file,
              short events,
              char* bytes,
              std::size_t size,
              const std::optional<Clock::time_point>& deadline) {
    while (size > 0) {
        int patience_ms = -1;
        if (deadline) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now());
            patience_ms = static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 3'600'000));
        }
        pollfd ready{file, events, 0};
        const int said = ::poll(&ready, 1, patience_ms);
        if (said < 0 && errno == EINTR) continue;
        if (said <= 0) return false;
        const ssize_t done = once(file, bytes, size);
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) return false;
        bytes += done;
        size -= static_cast<std::size_t>(done);
    }
    return true;
}

using Sizes = std::array<std::uint64_t, 2>;

}  // namespace

CameraMessage message_of(const CameraRequest& request) {
    const Json json = {{"kind", kKinds[static_cast<std::size_t>(request.kind)]},
                       {"camera", request.camera},
                       {"port", request.port},
                       {"setting", request.setting},
                       {"value", request.value},
                       {"exposure_s", request.exposure_s},
                       {"has_exposure", request.has_exposure},
                       {"deadline_ms", request.deadline.count()}};
    return {json.dump(-1, ' ', false, Json::error_handler_t::replace), ""};
}

CameraRequest request_in(const CameraMessage& message) {
    const Json json = parse_json(message.json, kWho);
    const JsonReader reader(kWho, json);
    CameraRequest request;
    request.kind = static_cast<CameraRequest::Kind>(number_of(reader["kind"], kKinds));
    request.camera = reader["camera"].text();
    request.port = reader["port"].text();
    request.setting = reader["setting"].text();
    request.value = reader["value"].text();
    request.exposure_s = reader["exposure_s"].number();
    request.has_exposure = reader["has_exposure"].boolean();
    request.deadline =
        std::chrono::milliseconds(static_cast<std::int64_t>(reader["deadline_ms"].number()));
    return request;
}

CameraMessage message_of(const CameraAnswer& answer) {
    Json json = {{"model", answer.state.model},
                 {"setting", json_of(answer.setting)},
                 {"file", answer.taken.file.name},
                 {"exposure_s", answer.taken.exposure_s},
                 {"problem", answer.taken.problem}};
    json["settings"] = Json::array();
    for (const CameraSetting& setting : answer.state.settings)
        json["settings"].push_back(json_of(setting));
    if (answer.state.battery) json["battery"] = *answer.state.battery;
    if (answer.state.shots_left) json["shots_left"] = *answer.state.shots_left;
    json["cameras"] = Json::array();
    for (const FoundCamera& found : answer.cameras)
        json["cameras"].push_back(
            {{"model", found.model}, {"port", found.port}, {"held_by", found.held_by}});
    if (answer.fault) {
        json["fault"] = {{"trouble", kTroubles[static_cast<std::size_t>(answer.fault->trouble())]},
                         {"why", answer.fault->why()},
                         {"fix", answer.fault->fix()}};
    }
    // One of the two: what was taken, or what is seen.
    const auto& taken = answer.taken.file.bytes;
    json["live_view"] = !answer.live_view.empty();
    return {json.dump(-1, ' ', false, Json::error_handler_t::replace),
            answer.live_view.empty()
                ? std::string(reinterpret_cast<const char*>(taken.data()), taken.size())
                : answer.live_view};
}

CameraAnswer answer_in(const CameraMessage& message) {
    const Json json = parse_json(message.json, kWho);
    const JsonReader reader(kWho, json);
    CameraAnswer answer;
    if (reader.has("fault")) {
        const JsonReader fault = reader["fault"];
        answer.fault =
            CameraFault(static_cast<CameraTrouble>(number_of(fault["trouble"], kTroubles)),
                        fault["why"].text(),
                        fault["fix"].text());
    }
    for (std::size_t k = 0; k < reader["cameras"].size(); ++k) {
        const JsonReader found = reader["cameras"].at(k);
        answer.cameras.push_back(
            {found["model"].text(), found["port"].text(), found["held_by"].text()});
    }
    answer.state.model = reader["model"].text();
    for (std::size_t k = 0; k < reader["settings"].size(); ++k)
        answer.state.settings.push_back(setting_in(reader["settings"].at(k)));
    if (reader.has("battery")) answer.state.battery = reader["battery"].number();
    if (reader.has("shots_left"))
        answer.state.shots_left = static_cast<int>(reader["shots_left"].number());
    answer.setting = setting_in(reader["setting"]);
    answer.taken.file.name = reader["file"].text();
    answer.taken.exposure_s = reader["exposure_s"].number();
    answer.taken.problem = reader["problem"].text();
    if (reader["live_view"].boolean()) {
        answer.live_view = message.bytes;
    } else {
        answer.taken.file.bytes.assign(message.bytes.begin(), message.bytes.end());
    }
    return answer;
}

bool send_message(int file, const CameraMessage& message) {
    const auto write_once = [](int to, void* bytes, std::size_t size) {
        return ::write(to, bytes, size);
    };
    Sizes sizes{message.json.size(), message.bytes.size()};
    std::string all(reinterpret_cast<const char*>(sizes.data()), sizeof(sizes));
    all += message.json + message.bytes;
    return transfer(write_once, file, POLLOUT, all.data(), all.size(), {});
}

std::optional<CameraMessage> receive_message(
    int file, std::optional<std::chrono::steady_clock::time_point> deadline) {
    const auto receive = [&](char* bytes, std::size_t size) {
        return transfer(::read, file, POLLIN, bytes, size, deadline);
    };
    Sizes sizes{};
    if (!receive(reinterpret_cast<char*>(sizes.data()), sizeof(sizes))) return std::nullopt;
    if (sizes[0] > kMostBytes || sizes[1] > kMostBytes)
        throw FileError(kWho, "", "a message of gigabytes", "a photograph");
    CameraMessage message{std::string(sizes[0], '\0'), std::string(sizes[1], '\0')};
    if (!receive(message.json.data(), sizes[0]) || !receive(message.bytes.data(), sizes[1]))
        return std::nullopt;
    return message;
}

}  // namespace livery
