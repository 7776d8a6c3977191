// Writes an MCAP file (mcap.dev/spec) from front to back, so that it may go to a pipe: chunks with their
// indexes, a summary, checksums.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runs/exports/output.h"

namespace hydro::exports {

using McapMap = std::vector<std::pair<std::string, std::string>>;

struct McapMessage {
  uint16_t channel = 0;
  uint32_t sequence = 0;
  uint64_t log_time = 0;      // ns
  uint64_t publish_time = 0;  // ns
  std::string_view data;
};

class McapFile {
 public:
  McapFile(Output* out, const std::string& library);

  // These return the number, counted from 1; a schema that already exists keeps its own number. Call them
  // before the first message.
  uint16_t AddSchema(const std::string& name, const std::string& encoding, const std::string& text);
  uint16_t AddChannel(uint16_t schema, const std::string& topic, const std::string& encoding,
                      const McapMap& metadata);
  void AddMetadata(const std::string& name, const McapMap& entries);
  void AddAttachment(const std::string& name, const std::string& media_type, const std::string& bytes);

  void AddMessage(const McapMessage& message);

  // Writes the summary and the end. Output::Finish() is left to the caller.
  void Finish();

 private:
  struct ChunkPlace {
    uint64_t start = 0, length = 0, index_length = 0, size = 0, first_time = 0, last_time = 0;
    std::map<uint16_t, uint64_t> indexes;  // by channel: place of the index of its messages
  };
  struct Place {
    std::string name, media_type;
    uint64_t start = 0, length = 0, data_size = 0;
  };

  void Emit(const std::string& bytes);
  uint64_t EmitRecord(uint8_t kind, const std::string& content);
  void FinishChunk();
  std::string Statistics() const;
  std::string ChunkIndex(const ChunkPlace& chunk) const;

  Output& out_;
  uint64_t position_ = 0;
  uint32_t checksum_ = 0;                        // of the bytes that were emitted
  std::vector<std::string> schemas_, channels_;  // records
  std::vector<Place> attachments_, metadata_;
  std::vector<ChunkPlace> chunks_;
  std::map<uint16_t, uint64_t> messages_;  // number of messages on each channel
  std::string chunk_;
  ChunkPlace open_;
  std::map<uint16_t, std::vector<std::pair<uint64_t, uint64_t>>>
      in_chunk_;  // time and place of each message, by channel
};

}  // namespace hydro::exports
