// Files that a file names and that lie outside of its own folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace livery {

/// Collects what a file in `folder` reads. Links count as where they lead.
class FilesElsewhere {
  public:
    explicit FilesElsewhere(const std::filesystem::path& folder);

    /// Nothing for files below the folder or among the shipped data.
    void add(const std::filesystem::path& file);
    /// "reads A and B, which lie elsewhere"; empty when there is none.
    std::string note() const;

  private:
    std::filesystem::path folder_, shipped_;
    std::vector<std::string> files_;
    std::size_t count_ = 0;
};

}  // namespace livery
