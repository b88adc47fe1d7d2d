#include "support/ptpip_camera.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/loopback.h"

namespace livery::testing {

namespace {

// Packets
constexpr std::uint32_t kInitCommand = 1, kInitCommandAck = 2, kInitEvent = 3, kInitEventAck = 4,
                        kRequest = 6, kResponse = 7, kEvent = 8, kStartData = 9, kData = 10,
                        kEndData = 12, kPing = 13, kPong = 14;
// Operations
constexpr std::uint16_t kGetDeviceInfo = 0x1001, kOpenSession = 0x1002, kCloseSession = 0x1003,
                        kGetStorageIds = 0x1004, kGetStorageInfo = 0x1005, kGetNumObjects = 0x1006,
                        kGetObjectHandles = 0x1007, kGetObjectInfo = 0x1008, kGetObject = 0x1009,
                        kDeleteObject = 0x100b, kInitiateCapture = 0x100e, kGetPropDesc = 0x1014,
                        kGetPropValue = 0x1015, kSetPropValue = 0x1016;
// Answers
constexpr std::uint16_t kOk = 0x2001, kGeneralError = 0x2002, kNotSupported = 0x2005,
                        kNoSuchObject = 0x2009, kNoSuchProperty = 0x200a, kStoreFull = 0x200c,
                        kAccessDenied = 0x200f, kDeviceBusy = 0x2019, kInvalidValue = 0x201c;
// Events and properties
constexpr std::uint16_t kObjectAdded = 0x4002, kCaptureComplete = 0x400d;
constexpr std::uint16_t kBattery = 0x5001, kCompression = 0x5004, kFNumber = 0x5007,
                        kFocusMode = 0x500a, kExposureTime = 0x500d, kExposureProgram = 0x500e,
                        kExposureIndex = 0x500f;
constexpr std::uint32_t kStore = 0x00010001;

// In 0.1 ms, in thirds of a stop as cameras say them
const std::vector<std::uint32_t> kTimes{
    5,     6,     8,     10,    13,    15,    20,    25,    31,    40,   50,
    63,    80,    100,   125,   166,   200,   250,   333,   400,   500,  666,
    769,   1000,  1250,  1666,  2000,  2500,  3000,  4000,  5000,  6000, 8000,
    10000, 13000, 16000, 20000, 25000, 32000, 40000, 50000, 60000, 80000};

/// How long the shutter is open: the steps themselves are exact.
double open_s(std::uint32_t said) {
    return std::exp2(std::round(3.0 * std::log2(said / 1e4)) / 3.0);
}

std::uint32_t said(double open_for_s) {
    return *std::min_element(kTimes.begin(), kTimes.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::abs(std::log(open_s(a) / open_for_s)) <
               std::abs(std::log(open_s(b) / open_for_s));
    });
}

template <typename T>
std::string little(T value) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return bytes;
}

template <typename T>
T read_little(const std::string& bytes, std::size_t at) {
    T value{};
    if (at + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

std::string text(const std::string& ascii) {
    if (ascii.empty()) return std::string(1, '\0');
    std::string bytes(1, static_cast<char>(ascii.size() + 1));
    for (const char c : ascii) bytes += {c, '\0'};
    return bytes + std::string(2, '\0');
}

template <typename T>
std::string list_of(const std::vector<T>& values) {
    std::string bytes = little(static_cast<std::uint32_t>(values.size()));
    for (const T value : values) bytes += little(value);
    return bytes;
}

/// A property with its choices; none: any value.
template <typename T>
std::string property(std::uint16_t code,
                     std::uint16_t type,
                     T value,
                     const std::vector<T>& choices,
                     bool can_be_set) {
    std::string bytes = little(code) + little(type) +
                        little(static_cast<std::uint8_t>(can_be_set)) + little(value) +
                        little(value);
    if (choices.empty()) return bytes + little(std::uint8_t{0});
    bytes += little(std::uint8_t{2}) + little(static_cast<std::uint16_t>(choices.size()));
    for (const T choice : choices) bytes += little(choice);
    return bytes;
}

std::string packet(std::uint32_t type, const std::string& payload) {
    return little(static_cast<std::uint32_t>(payload.size() + 8)) + little(type) + payload;
}

struct Packet {
    std::uint32_t type = 0;
    std::string payload;
};

bool receive(int socket, char* to, std::size_t size) {
    while (size > 0) {
        const ssize_t n = ::recv(socket, to, size, 0);
        if (n <= 0) return false;
        to += n;
        size -= static_cast<std::size_t>(n);
    }
    return true;
}

std::optional<Packet> read_packet(int socket) {
    char head[8];
    if (!receive(socket, head, sizeof(head))) return std::nullopt;
    const std::string bytes(head, sizeof(head));
    const auto size = read_little<std::uint32_t>(bytes, 0);
    if (size < 8 || size > (64u << 20u)) return std::nullopt;
    Packet packet{read_little<std::uint32_t>(bytes, 4), std::string(size - 8, '\0')};
    if (!receive(socket, packet.payload.data(), packet.payload.size())) return std::nullopt;
    return packet;
}

}  // namespace

struct PtpIpCamera::Connection {
    int socket = -1;
    std::mutex sending;
    explicit Connection(int s) : socket(s) {}
    ~Connection() { ::close(socket); }
    bool send(const std::string& bytes) {
        const std::lock_guard lock(sending);
        return send_all(socket, bytes);
    }
    void respond(std::uint16_t code,
                 std::uint32_t transaction,
                 const std::vector<std::uint32_t>& parameters = {}) {
        std::string payload = little(code) + little(transaction);
        for (const std::uint32_t value : parameters) payload += little(value);
        send(packet(kResponse, payload));
    }
    void send_data(std::uint32_t transaction, const std::string& data, std::size_t declared) {
        send(
            packet(kStartData, little(transaction) + little(static_cast<std::uint64_t>(declared))));
        send(packet(kEndData, little(transaction) + data));
    }
};

PtpIpCamera::PtpIpCamera(std::function<PtpPicture(const PtpSettings&)> shoot)
    : shoot_(std::move(shoot)) {
    listening_ = listen_on_loopback(port_);
    listener_ = std::thread([this] { listen(); });
}

PtpIpCamera::~PtpIpCamera() {
    stop_ = true;
    listener_.join();
    hang_up();
    for (std::thread& thread : threads_) thread.join();
    ::close(listening_);
}

std::string PtpIpCamera::port() const { return "ptpip:127.0.0.1:" + std::to_string(port_); }

void PtpIpCamera::set(PtpMishap mishap) {
    mishap_ = mishap;
    if (mishap == PtpMishap::unplugged) hang_up();
}

PtpSettings PtpIpCamera::settings() const {
    const std::lock_guard lock(mutex_);
    return settings_;
}

std::size_t PtpIpCamera::on_card() const {
    const std::lock_guard lock(mutex_);
    return objects_.size();
}

void PtpIpCamera::hang_up() {
    const std::lock_guard lock(mutex_);
    for (const auto& connection : connections_) ::shutdown(connection->socket, SHUT_RDWR);
    connections_.clear();
    events_.reset();
}

void PtpIpCamera::listen() {
    while (!stop_) {
        pollfd waiting{listening_, POLLIN, 0};
        if (::poll(&waiting, 1, 20) <= 0) continue;
        const int socket = ::accept(listening_, nullptr, nullptr);
        if (socket < 0) continue;
        const int on = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
        const auto connection = std::make_shared<Connection>(socket);
        if (mishap_ == PtpMishap::unplugged) continue;
        const std::lock_guard lock(mutex_);
        connections_.push_back(connection);
        threads_.emplace_back([this, connection] { serve(connection); });
    }
}

void PtpIpCamera::serve(const std::shared_ptr<Connection>& connection) {
    std::uint32_t transaction = 0;
    std::uint16_t operation = 0;
    std::vector<std::uint32_t> parameters;
    std::string data;
    while (const auto received = read_packet(connection->socket)) {
        if (stop_) return;
        if (mishap_ == PtpMishap::asleep) continue;
        const std::string& payload = received->payload;
        switch (received->type) {
            case kInitCommand:
                // Number of the connection, GUID, name in UTF-16, version
                connection->send(packet(kInitCommandAck,
                                        little(std::uint32_t{1}) + std::string(16, 'L') +
                                            std::string("L\0i\0v\0e\0r\0y\0\0\0", 14) +
                                            little(std::uint32_t{0x00010000})));
                break;
            case kInitEvent: {
                connection->send(packet(kInitEventAck, ""));
                const std::lock_guard lock(mutex_);
                events_ = connection;
                break;
            }
            case kPing:
                connection->send(packet(kPong, ""));
                break;
            case kRequest: {
                const auto phase = read_little<std::uint32_t>(payload, 0);
                operation = read_little<std::uint16_t>(payload, 4);
                transaction = read_little<std::uint32_t>(payload, 6);
                parameters.clear();
                for (std::size_t at = 10; at + 4 <= payload.size(); at += 4)
                    parameters.push_back(read_little<std::uint32_t>(payload, at));
                data.clear();
                if (phase != 2) answer(*connection, operation, transaction, parameters, data);
                break;
            }
            case kData:
            case kEndData:
                data += payload.substr(std::min<std::size_t>(4, payload.size()));
                if (received->type == kEndData)
                    answer(*connection, operation, transaction, parameters, data);
                break;
            default:
                break;
        }
    }
}

void PtpIpCamera::send_event(std::uint16_t code,
                             std::uint32_t transaction,
                             const std::vector<std::uint32_t>& parameters) {
    std::shared_ptr<Connection> events;
    {
        const std::lock_guard lock(mutex_);
        events = events_;
    }
    if (!events) return;
    std::string payload = little(code) + little(transaction);
    for (const std::uint32_t value : parameters) payload += little(value);
    events->send(packet(kEvent, payload));
}

void PtpIpCamera::photograph(std::uint32_t transaction) {
    const PtpPicture picture = shoot_(settings());
    std::uint32_t handle = 0;
    {
        const std::lock_guard lock(mutex_);
        handle = next_handle_++;
        objects_[handle] = picture;
    }
    ++photographs_;
    send_event(kObjectAdded, transaction, {handle});
    send_event(kCaptureComplete, transaction, {});
}

void PtpIpCamera::answer(Connection& connection,
                         std::uint16_t operation,
                         std::uint32_t transaction,
                         const std::vector<std::uint32_t>& parameters,
                         const std::string& data) {
    const auto parameter = [&](std::size_t k) {
        return k < parameters.size() ? parameters[k] : 0u;
    };
    const auto give = [&](const std::string& bytes) {
        connection.send_data(transaction, bytes, bytes.size());
        connection.respond(kOk, transaction);
    };
    const PtpMishap mishap = mishap_;
    if (mishap == PtpMishap::busy && operation != kGetDeviceInfo && operation != kOpenSession &&
        operation != kCloseSession) {
        return connection.respond(kDeviceBusy, transaction);
    }
    switch (operation) {
        case kGetDeviceInfo:
            return give(little(std::uint16_t{100}) + little(std::uint32_t{0}) +
                        little(std::uint16_t{0}) + text("") + little(std::uint16_t{0}) +
                        list_of<std::uint16_t>({kGetDeviceInfo,
                                                kOpenSession,
                                                kCloseSession,
                                                kGetStorageIds,
                                                kGetStorageInfo,
                                                kGetNumObjects,
                                                kGetObjectHandles,
                                                kGetObjectInfo,
                                                kGetObject,
                                                kDeleteObject,
                                                kInitiateCapture,
                                                kGetPropDesc,
                                                kGetPropValue,
                                                kSetPropValue}) +
                        list_of<std::uint16_t>({kObjectAdded, kCaptureComplete}) +
                        list_of<std::uint16_t>({kBattery,
                                                kCompression,
                                                kFNumber,
                                                kFocusMode,
                                                kExposureTime,
                                                kExposureProgram,
                                                kExposureIndex}) +
                        list_of<std::uint16_t>({0x3801, 0x3811}) +
                        list_of<std::uint16_t>({0x3801, 0x3811}) + text("Livery") +
                        text("Loopback 1") + text("1.0") + text("0001"));
        case kOpenSession:
        case kCloseSession:
            return connection.respond(kOk, transaction);
        case kGetStorageIds:
            return give(list_of<std::uint32_t>({kStore}));
        case kGetStorageInfo:
            return give(
                little(std::uint16_t{4}) + little(std::uint16_t{3}) + little(std::uint16_t{0}) +
                little(std::uint64_t{32'000'000'000}) +
                little(std::uint64_t{mishap == PtpMishap::card_full ? 0u : 16'000'000'000u}) +
                little(std::uint32_t{mishap == PtpMishap::card_full ? 0u : 600u}) + text("card") +
                text(""));
        case kGetNumObjects: {
            const std::lock_guard lock(mutex_);
            return connection.respond(
                kOk, transaction, {static_cast<std::uint32_t>(objects_.size())});
        }
        case kGetObjectHandles: {
            std::vector<std::uint32_t> handles;
            {
                const std::lock_guard lock(mutex_);
                for (const auto& [handle, object] : objects_) handles.push_back(handle);
            }
            return give(list_of(handles));
        }
        case kGetObjectInfo:
        case kGetObject:
        case kDeleteObject: {
            PtpPicture object;
            {
                const std::lock_guard lock(mutex_);
                const auto found = objects_.find(parameter(0));
                if (found == objects_.end()) return connection.respond(kNoSuchObject, transaction);
                object = found->second;
                if (operation == kDeleteObject) objects_.erase(found);
            }
            if (operation == kDeleteObject) return connection.respond(kOk, transaction);
            if (operation == kGetObject && mishap == PtpMishap::half_a_file) {
                connection.send_data(transaction,
                                     object.bytes.substr(0, object.bytes.size() / 2),
                                     object.bytes.size() / 2);
                return connection.respond(kOk, transaction);
            }
            if (operation == kGetObject) return give(object.bytes);
            const bool jpeg = object.name.ends_with(".JPG");
            return give(
                little(kStore) + little(static_cast<std::uint16_t>(jpeg ? 0x3801 : 0x3811)) +
                little(std::uint16_t{0}) + little(static_cast<std::uint32_t>(object.bytes.size())) +
                little(std::uint16_t{0}) + little(std::uint32_t{0}) + little(std::uint32_t{0}) +
                little(std::uint32_t{0}) + little(std::uint32_t{0}) + little(std::uint32_t{0}) +
                little(std::uint32_t{16}) + little(std::uint32_t{0}) + little(std::uint16_t{0}) +
                little(std::uint32_t{0}) + little(std::uint32_t{0}) + text(object.name) +
                text("20260101T120000") + text("20260101T120000") + text(""));
        }
        case kInitiateCapture:
            if (mishap == PtpMishap::card_full) return connection.respond(kStoreFull, transaction);
            connection.respond(kOk, transaction);
            if (mishap != PtpMishap::never_photographs) photograph(transaction);
            return;
        case kGetPropDesc:
        case kGetPropValue: {
            const PtpSettings now = settings();
            const bool automatic = mishap == PtpMishap::automatic_exposure;
            const std::uint32_t time = said(now.exposure_s);
            const auto f_number = static_cast<std::uint16_t>(std::lround(now.f_number * 100.0));
            const auto iso = static_cast<std::uint16_t>(now.iso);
            const auto whole = [&](const std::string& description, std::size_t size) {
                give(operation == kGetPropDesc ? description : description.substr(5 + size, size));
            };
            switch (parameter(0)) {
                case kBattery:
                    return whole(property<std::uint8_t>(kBattery, 2, 80, {}, false), 1);
                case kCompression:
                    return whole(
                        property<std::uint8_t>(kCompression, 2, now.raw ? 4 : 2, {2, 4}, true), 1);
                case kFNumber:
                    return whole(
                        property<std::uint16_t>(kFNumber, 4, f_number, {400, 560, 800, 1100}, true),
                        2);
                case kFocusMode:
                    return whole(property<std::uint16_t>(kFocusMode, 4, 1, {1, 2}, true), 2);
                case kExposureTime:
                    return whole(
                        property<std::uint32_t>(kExposureTime, 6, time, kTimes, !automatic), 4);
                case kExposureProgram:
                    return whole(property<std::uint16_t>(
                                     kExposureProgram, 4, automatic ? 2 : 1, {1, 2, 3, 4}, true),
                                 2);
                case kExposureIndex:
                    return whole(
                        property<std::uint16_t>(kExposureIndex, 4, iso, {100, 200, 400, 800}, true),
                        2);
                default:
                    return connection.respond(kNoSuchProperty, transaction);
            }
        }
        case kSetPropValue: {
            const std::lock_guard lock(mutex_);
            switch (parameter(0)) {
                case kCompression:
                    settings_.raw = read_little<std::uint8_t>(data, 0) == 4;
                    break;
                case kFNumber:
                    settings_.f_number = read_little<std::uint16_t>(data, 0) / 100.0;
                    break;
                case kExposureTime: {
                    const auto time = read_little<std::uint32_t>(data, 0);
                    if (mishap == PtpMishap::automatic_exposure)
                        return connection.respond(kAccessDenied, transaction);
                    if (std::find(kTimes.begin(), kTimes.end(), time) == kTimes.end())
                        return connection.respond(kInvalidValue, transaction);
                    settings_.exposure_s = open_s(time);
                    break;
                }
                case kExposureIndex:
                    settings_.iso = read_little<std::uint16_t>(data, 0);
                    break;
                case kFocusMode:
                case kExposureProgram:
                    break;
                default:
                    return connection.respond(kNoSuchProperty, transaction);
            }
            return connection.respond(kOk, transaction);
        }
        default:
            return connection.respond(operation == 0 ? kGeneralError : kNotSupported, transaction);
    }
}

}  // namespace livery::testing
