// A reader of QR codes by others, loaded where it is installed; nothing of it is needed to build.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <dlfcn.h>

namespace livery {

class ZBar {
  public:
    ZBar() : library_(::dlopen("libzbar.so.0", RTLD_NOW)) {}
    ~ZBar() {
        if (library_) ::dlclose(library_);
    }
    ZBar(const ZBar&) = delete;
    ZBar& operator=(const ZBar&) = delete;
    bool is_there() const { return library_ != nullptr; }

    /// What it reads from rows of 8-bit grey pixels; empty unless there is one code.
    std::string read(const std::vector<unsigned char>& grey, int width, int height) const {
        const auto scanner = function<void*()>("zbar_image_scanner_create")();
        const auto image = function<void*()>("zbar_image_create")();
        function<void(void*, unsigned long)>("zbar_image_set_format")(image, 0x30303859);  // Y800
        function<void(void*, unsigned, unsigned)>("zbar_image_set_size")(
            image, static_cast<unsigned>(width), static_cast<unsigned>(height));
        function<void(void*, const void*, unsigned long, void*)>("zbar_image_set_data")(
            image, grey.data(), grey.size(), nullptr);
        std::string text;
        if (function<int(void*, void*)>("zbar_scan_image")(scanner, image) == 1) {
            const void* symbol =
                function<const void*(const void*)>("zbar_image_first_symbol")(image);
            text = function<const char*(const void*)>("zbar_symbol_get_data")(symbol);
        }
        function<void(void*)>("zbar_image_destroy")(image);
        function<void(void*)>("zbar_image_scanner_destroy")(scanner);
        return text;
    }

  private:
    template <typename Signature>
    Signature* function(const char* name) const {
        void* found = ::dlsym(library_, name);
        if (!found) throw std::runtime_error(std::string("libzbar has no ") + name);
        return reinterpret_cast<Signature*>(found);
    }
    void* library_;
};

}  // namespace livery
