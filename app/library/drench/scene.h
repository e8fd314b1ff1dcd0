#pragma once

#include <drench/error.h>
#include <drench/shape.h>
#include <drench/vec3.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace drench {

/// Where a body is against where the scene has put it: turned about a point, then shifted.
struct Pose {
    Vec3 shift = {};  ///< [cm]
    Vec3 turn = {};   ///< axis, as long as the angle is large [rad]
    Vec3 about = {};  ///< point of the scene that turning leaves where it is [cm]
};

/// Where a body is at a time [s]. It must be smooth, and of one step say the same whenever it is asked: what it looks at may change from step to
/// step, as by forces, if at the end of a step it goes on from where it was.
using Motion = std::function<Pose(double time)>;

/// Liquid that is there at the start, or with `emit` among `more` comes later.
struct Source {
    Shape shape;
    Vec3 velocity = {};     ///< [cm/s]
    std::string name = {};  ///< left out: its number
    std::string more = {};  ///< further keys as scene files have them: "fill: jittered, emit: [{from: 0, to: 0.5}]"
};

struct Obstacle {
    Shape shape;
    bool inside = false;    ///< liquid and fabric are inside of the shape: a tank
    Motion motion = {};     ///< left out: it rests
    std::string more = {};  ///< further keys as scene files have them: "friction_angle: 30"
};

/// A scene before it runs: a tree of keys as in scene files, from a file, from a text or put together. Units are those of scene files:
/// cm, s, g, dyn, degrees. All that a file may say can be said here in the same words; what is wrong is told as of files.
class Scene {
 public:
    /// An empty one, which needs liquid or fabric. Its name may have a-z, 0-9 and _.
    explicit Scene(const std::string& name = "scene");
    /// A scene file, or one of its variants. Throws InputError.
    static Scene load(const std::string& file, const std::string& variant = "");
    /// What would stand in such a file. Throws InputError.
    static Scene parse(const std::string& text);
    Scene(const Scene&);
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene) noexcept;
    ~Scene();

    /// What --set does for the program: set("transfer.modes", 8), set("materials.wool", "{young: 6.6e+7, density: 1.32}"). Throws InputError where
    /// this is no key and value; whether scenes have such a key is found when the whole is looked at.
    void set(std::string_view key, std::string_view value);
    void set(std::string_view key, const Vec3& value);
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void set(std::string_view key, Number value)
    {
        if constexpr (std::is_same_v<Number, bool>) set(key, std::string_view(value ? "true" : "false"));
        else if constexpr (std::is_integral_v<Number>) set(key, std::string_view(std::to_string(value)));
        else setNumber(key, value);
    }

    void add(const Source& source);
    void add(const std::string& name, const Obstacle& obstacle);
    /// A piece of fabric by what follows its name in scene files: addFabric("sheet", "{woven_yarns: {material: wool, ...}}").
    void addFabric(const std::string& name, const std::string& keys);

    /// Reads the whole, as a simulation does before it starts. Throws InputError at the first mistake.
    void check() const;
    /// What `drench check` prints: every setting with its unit and meaning, as a scene file. Motions of one's own are not in it. Throws InputError.
    std::string resolved() const;
    /// What is not wrong but should be known, as keys that nothing reads. Throws InputError.
    std::vector<std::string> notes() const;

    struct Parts;  // what stands behind it
    const Parts& parts() const { return *parts_; }

 private:
    explicit Scene(std::unique_ptr<Parts> parts);
    void setNumber(std::string_view key, double value);

    std::unique_ptr<Parts> parts_;
};

}  // namespace drench
