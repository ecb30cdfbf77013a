#include "gis/hdf4_output.h"

#include <cstdint>
#include <type_traits>

#include <fmt/format.h>
#include <hdf/mfhdf.h>

#include "base/error.h"
#include "base/files.h"

namespace pyroscene::gis {
namespace {

/// Calls `f` with a value of the C++ type and HDF4's number of it.
template <class F>
auto with_type(SampleType type, const F& f) {
    return with_sample(type, [&](auto sample) {
        using Sample = decltype(sample);
        constexpr ::int32 kNumber = std::is_same_v<Sample, std::uint8_t>    ? DFNT_UINT8
                                    : std::is_same_v<Sample, std::int16_t>  ? DFNT_INT16
                                    : std::is_same_v<Sample, std::uint16_t> ? DFNT_UINT16
                                    : std::is_same_v<Sample, std::int32_t>  ? DFNT_INT32
                                    : std::is_same_v<Sample, float>         ? DFNT_FLOAT32
                                                                            : DFNT_FLOAT64;
        return f(sample, kNumber);
    });
}

void require(bool done, const std::string& subject, const std::string& what) {
    if (!done) throw runtime_error(subject, "cannot be written: " + what);
}

bool set_text(::int32 owner, const std::string& name, const std::string& text) {
    return text.empty() ||
           SDsetattr(owner, name.c_str(), DFNT_CHAR8, static_cast<::int32>(text.size()), text.c_str()) != FAIL;
}

bool set_attribute(::int32 owner, const std::string& name, const Attribute& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return set_text(owner, name, *text);
    const auto& numbers = std::get<Numbers>(value);
    return with_type(numbers.type, [&](auto sample, ::int32 type) {
        const std::vector<decltype(sample)> typed(numbers.values.begin(), numbers.values.end());
        return SDsetattr(owner, name.c_str(), type, static_cast<::int32>(typed.size()), typed.data()) != FAIL;
    });
}

/// Opened data set, closed at the end.
struct DataSet {
    ::int32 id = FAIL;
    explicit DataSet(::int32 opened) : id(opened) {}
    DataSet(const DataSet&) = delete;
    DataSet& operator=(const DataSet&) = delete;
    ~DataSet() { SDendaccess(id); }
};

/// Compressed; a variable that comes in planes in chunks of one plane, because a compressed whole can only be written at once.
bool set_compression(::int32 set, const ArrayVariable& v, const std::vector<::int32>& edges) {
    comp_info deflate{};
    deflate.deflate.level = 1;
    if (!v.make || edges.size() != 3) return SDsetcompress(set, COMP_CODE_DEFLATE, &deflate) != FAIL;
    HDF_CHUNK_DEF chunk{};
    chunk.comp.comp_type = COMP_CODE_DEFLATE;
    chunk.comp.cinfo = deflate;
    for (std::size_t k = 0; k < edges.size(); ++k) chunk.comp.chunk_lengths[k] = k == 0 ? 1 : edges[k];
    return SDsetchunk(set, chunk, HDF_CHUNK | HDF_COMP) != FAIL;
}

void write_variable(::int32 file_id, const ArrayFile& file, const ArrayVariable& v, const std::string& subject) {
    const auto shape = array_shape(file, v, subject);
    std::vector<::int32> edges(shape.begin(), shape.end());
    with_type(v.type, [&](auto sample, ::int32 type) {
        using Sample = decltype(sample);
        const DataSet set(SDcreate(file_id, v.name.c_str(), type, static_cast<::int32>(edges.size()), edges.data()));
        require(set.id != FAIL, subject, v.name);
        for (std::size_t k = 0; k < edges.size(); ++k)
            require(SDsetdimname(SDgetdimid(set.id, static_cast<intn>(k)), v.dimensions[k].c_str()) != FAIL, subject,
                    v.name);
        require(set_compression(set.id, v, edges), subject, v.name);
        bool done = set_text(set.id, "long_name", v.long_name) && set_text(set.id, "units", v.unit);
        if (v.fill) {
            Sample fill = static_cast<Sample>(*v.fill);
            done = done && SDsetfillvalue(set.id, &fill) != FAIL;
        }
        for (const auto& [key, value] : v.attributes) done = done && set_attribute(set.id, key, value);
        for_each_part(file, v, subject, [&](const ArrayPart& part) {
            std::vector<::int32> start(part.start.begin(), part.start.end()), count(part.count.begin(), part.count.end());
            auto typed = part.as<Sample>();
            done = done && SDwritedata(set.id, start.data(), nullptr, count.data(), typed.data()) != FAIL;
        });
        require(done, subject, v.name);
    });
}

/// Opened file, closed at the end or by close().
class File {
public:
    explicit File(const std::filesystem::path& path) : id_(SDstart(path.c_str(), DFACC_CREATE)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { close(); }
    [[nodiscard]] ::int32 id() const { return id_; }
    bool close() {
        const bool done = id_ == FAIL || SDend(id_) != FAIL;
        id_ = FAIL;
        return done;
    }

private:
    ::int32 id_;
};

}  // namespace

void write_hdf4(const std::filesystem::path& path, const ArrayFile& file) {
    const std::string subject = path.string();
    AtomicFile target(path);
    File out(target.path());
    require(out.id() != FAIL, subject, "HDF4 cannot create it");
    for (const auto& [name, text] : file.attributes) require(set_text(out.id(), name, text), subject, name);
    for (const auto& variable : file.variables) write_variable(out.id(), file, variable, subject);
    require(out.close(), subject, "HDF4 cannot close it");
    target.commit();
}

}  // namespace pyroscene::gis
