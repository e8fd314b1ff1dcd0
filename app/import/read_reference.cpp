#include "app/import/read_reference.h"

#include <fmt/format.h>

namespace app {

using namespace reference;

namespace {

double positive(const XmlElement& element, const char* attribute, double value)
{
    if (!(value > 0.0)) element.fail(fmt::format("{} must be above 0, not {}", attribute, value));
    return value;
}

Run readRun(const XmlElement& scene)
{
    Run run;
    const XmlElement duration = scene.child("duration"), integrator = scene.child("integrator");
    if (!duration) scene.fail("has no <duration time=\"…\"/>, the length of the run in seconds; add it");
    if (!integrator) scene.fail("has no <integrator type=\"linearized-implicit-euler\" dt=\"…\"/>, which gives the time step; add it");
    run.duration = positive(duration, "duration@time", duration.number("time"));
    run.line = integrator.line();
    run.dt = positive(integrator, "integrator@dt", integrator.number("dt"));
    if (integrator.has("picMethod")) run.picMethod = integrator.integer("picMethod", 0);
    if (run.picMethod && (*run.picMethod < 0 || *run.picMethod > 2))
        integrator.fail(fmt::format("integrator@picMethod: {} is unknown; 0 is PIC, 1 APIC, 2 PolyPIC", *run.picMethod));
    if (integrator.has("apic")) run.apic = integrator.flag("apic", false);
    run.maxIterations = integrator.integer("maxiters", run.maxIterations);
    run.viscositySubsteps = integrator.integer("viscositysubsteps", run.viscositySubsteps);
    integrator.text("type");
    return run;
}

double readCell(const XmlElement& scene)
{
    const XmlElement bucket = scene.child("bucketinfo");
    if (!bucket) return 1.0;  // 5 cm in 5 cells
    const double size = positive(bucket, "bucketinfo@size", bucket.number("size", 5.0));
    return size / positive(bucket, "bucketinfo@numcells", bucket.integer("numcells", 5));
}

Camera readCamera(const XmlElement& element)
{
    Camera camera;
    camera.distance = element.number("dist", 0.0);
    camera.fov = element.number("fov", 40.0);
    if (const XmlElement turn = element.child("rotation"))
        camera.rotation = {turn.number("x", 0.0), turn.number("y", 0.0), turn.number("z", 0.0), turn.number("w", 1.0)};
    if (const XmlElement center = element.child("center"))
        camera.center = {center.number("x", 0.0), center.number("y", 0.0), center.number("z", 0.0)};
    return camera;
}

}  // namespace

Scene readReferenceScene(const XmlFile& file, const ImportOptions& options, NamesRead& names)
{
    const XmlElement root(file, file.root(), names);
    Scene scene;
    scene.run = readRun(root);
    scene.run.cell = readCell(root);
    for (const XmlElement& pull : root.children("simplegravity"))
        scene.run.gravity += Vec3(pull.number("fx", 0.0), pull.number("fy", 0.0), pull.number("fz", 0.0));
    if (const XmlElement text = root.child("description")) scene.description = text.text("text");
    if (const XmlElement tag = root.child("scenetag")) scene.tag = tag.text("tag");
    if (const XmlElement camera = root.child("camera")) scene.camera = readCamera(camera);
    if (const XmlElement color = root.child("backgroundcolor")) scene.background = Vec3(color.number("r"), color.number("g"), color.number("b"));
    for (const XmlElement& spring : root.children("springforce")) scene.springLines.push_back(spring.line());
    if (const XmlElement pose = root.child("pose")) scene.poseLine = pose.line();
    scene.liquid = readLiquidInfo(root, options.legacyThreadCount);
    scene.materials = readReferenceMaterials(root, options);
    scene.fields = readReferenceFields(root);
    scene.scripts = readReferenceScripts(root);
    readReferenceFabric(root, scene);
    return scene;
}

}  // namespace app
