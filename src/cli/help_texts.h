// SPDX-License-Identifier: GPL-3.0-or-later
// Notes printed by --help below the options.
#pragma once

namespace opaline {

inline constexpr const char* kExamples = R"(Examples:
  opaline view bunny.json
  opaline info bunny.json
  opaline render statue.glb -o statue.png
  opaline import statue.glb -o statue.json
  opaline render bunny.json -o bunny.exr -o bunny.png
  opaline render bunny.json -o draft.png --method lambert --resolution 256x256
  opaline render bunny.json -o bunny.exr --target-error 1% --verify
  opaline render bunny.json -o bunny.exr --time-budget 2s
  opaline render bunny.json -o warm.exr --set media.marble.specular_ior=1.4 --set lights.back.intensity=[9e4,7e4,5e4]
  opaline render bunny.json -o bunny.exr --until-error 2%
  opaline render bunny.json -o reference.exr --method direct --until-error 2% --resume sums.exr
  opaline render bunny.json -o bunny.exr --log json --threads 4
  opaline compare bunny.exr reference.exr --fail-above 1%
  opaline bench bunny.json -o report --resolution 256x256
  opaline profile marble -o marble
  opaline render bunny.json -o turned.exr --cache stages --set camera.position=[0,50,200]
  opaline render bunny.json -o out.####.exr --frames 1-24 --cache stages
  opaline turntable statue.glb -o turn.mp4
  opaline cache ls stages

Exit codes: 0 done, 1 a comparison failed, 2 bad input, 3 the run failed (I/O, memory), 130 interrupted (Ctrl-C; earlier output files remain).)";

inline constexpr const char* kRenderNotes = R"(Each option that changes the image is a short form of --set:
  --spp 4            --set film.samples_per_pixel=4
  --resolution 64x48 --set film.resolution=[64,48]
  --crop 0,0,16,16   --set film.crop=[0,0,16,16]
  --method, --evaluator, --seed, --entry-samples, --until-error: --set settings.<name>=...
  --exposure, --view: --set film.<name>=...
  settings without an option, such as bounces and reenter (light across the air): --set settings.<name>=...
opaline applies these options first and then each --set in order. The last value wins.

--target-error is the mean relative error of the diffuse light over the translucent pixels, in the worst channel. It
excludes antialiasing; set --spp yourself. With volume_diffusion, by --method or by auto for all bodies, the error is
measured against --method volume and includes the model error, bounded by the plan's expected
model error. If the target is below the least error that opaline can promise, a warning states that error and opaline
uses it. With hierarchical in a body, the error excludes that of the radial profile; a warning says so if auto chose it.
By hierarchical alone, it is the error against the converged --method direct. --verify replaces auto by hierarchical. opaline estimates the error
on a small image and adds samples until the estimate is low enough. --verify measures the error of the result, at a cost
that grows with the square of the accuracy. The closing line "repeat with" is a command that makes the same pixels
without choosing. With --frames, opaline chooses the settings once, at settings.reference_frame, and all frames share
them, to avoid flicker.

--time-budget is the CPU time of the whole program (all threads, user and system), as in the closing table. It
includes start, loading, choosing and writing, but not --verify. opaline predicts cost and error from small images,
tiles of the full image and small files, and takes as many samples as the budget allows, up to settings.max_samples. With
volume_diffusion, by --method or by auto for some bodies, it takes cells as small as the budget allows. If even the
cheapest image exceeds the budget, opaline renders it and a warning states the expected time. The resolution, --spp and
settings.light_samples stay as you set them. The choice depends on the clock; the "repeat with" command does not. With
--method direct, opaline stops when the budget ends.

--until-error is the noise of the image against its own converged image: the standard error of a pixel, rms, in the
worst channel. It replaces --spp: pixels have 8 to 1,024 camera rays, the noisiest the most. With --method direct, all
pixels continue until the noise of the diffuse light is that; with volume, random walks until that of their cells is.)";

inline constexpr const char* kMergeNotes =
    R"(Each machine of a farm renders a part with the same options. The merged image has the bytes of the one that opaline
render without --part writes, with its layers and metadata. volume has at most 16 parts, each with some of its passes of
random walks; direct has at most as many as the image has tiles of 16 x 16 pixels, each with all passes over some of the
tiles. The image needs a fixed number of passes, so --until-error has no parts. An interrupted part is resumed by
repeating its command. merge reads the scene again, under the path where the parts were rendered.

Examples:
  opaline render bunny.json --method volume --part 1/2 -o 1.part
  opaline render bunny.json --method volume --part 2/2 -o 2.part
  opaline merge 1.part 2.part -o bunny.exr

Exit codes: as opaline render.)";

inline constexpr const char* kTurntableNotes =
    R"(The camera circles its look_at once, counter-clockwise seen from above; camera.up is the axis. The lights stay with the
scene. All frames share the light at the samples, so a frame costs little more than with lambert. A repeated command
skips the frames that exist. A movie is encoded by ffmpeg (H.264); until it is complete, its frames are in a folder
beside it, FILE.mp4.frames.

Examples:
  opaline turntable statue.glb -o turn.mp4
  opaline turntable bunny.json -o turn.####.exr --frames 96 --resolution 1024x1024 --spp 9

Exit codes: as opaline render.)";

inline constexpr const char* kImportNotes =
    R"(Other commands accept an asset in place of a scene file and convert it in the same way. Each line on stderr reports the
conversion of a value, or a part that is not imported.

  glTF    meshes, nodes, skins at rest, morph targets with their weights, cameras, lights (KHR_lights_punctual)
          and materials. A scattering material
          (KHR_materials_volume with KHR_materials_volume_scatter or KHR_materials_scatter) becomes a medium with
          sigma_a and sigma_s in 1/mm. Other materials are opaque, with base colour, metalness, roughness and
          specularFactor. Textures may be in the asset or in separate files; samplers are ignored. Lengths are metres.
          1 candela becomes 1e6 W/sr and 1 lux becomes 1 W/mm^2; the exposure of the PNG adapts to the brightness.
  .mtlx   the constants, images and bump of open_pbr_surface and standard_surface. A material with subsurface scattering becomes a
          medium with subsurface_color and subsurface_radius, in the asset's unit; others are opaque, with base
          colour, metalness and specular reflection.
  OBJ     meshes, one shape per usemtl, with Kd, map_Kd and the bump map of its MTL. Lengths are read as millimetres.
  PLY, STL, OFF   one opaque shape, grey or with its vertex colours. Lengths are read as millimetres.

opaline reads the files that an asset refers to only from the asset's folder and below. It refuses other paths and
symbolic links that leave the folder, unless --allow-outside is given. If a path does not exist (a path of another
machine, for example), opaline uses the file of the same name in the asset's folder.

Without a camera, the image is a three-quarter view of the whole asset. Without lights, opaline adds a key, a fill and
a rim light, which are invisible to the camera, and a grey backdrop.

Examples:
  opaline import statue.glb -o statue.json
  opaline render statue.glb -o statue.png
  opaline import bunny.obj --material skin.mtlx#SR_skin -o bunny.json

Exit codes: 0 done, 2 the asset is broken, 3 the scene file cannot be written.)";

inline constexpr const char* kViewNotes =
    R"(Prints a URL. In a desktop session it also opens the URL in the browser (by xdg-open). All browser windows show and edit
the same scene. The page loads nothing from other hosts. Each change shows a coarse image at once, then a sharper one,
and then the final image, identical to that of opaline render. A new change cancels the current image. Ctrl-C ends the
view.

Drop an asset with its textures onto the page, or press "Open...", to view it: .glb, .gltf, .obj, .ply, .stl or .off. An
environment map (.exr, .hdr) replaces the lights. Files dropped are stored in the folder opaline-view of the current
folder, each drop in a folder of its own: at most 256 files and 2 GiB. Without a scene, the view starts with a ball.
With --allow-outside, dropped assets are refused.

The view follows changes of the scene file and its meshes on the disk, with the page's edits; not those of textures,
material libraries and buffers.

The view never writes to the scene file. "Save scene" writes another scene file in its folder, and "Render final" an
image, under a name of your choice that does not exist yet. Both use the mesh files of the scene.

Orbit, pan and dolly move a free camera. The scene's own camera, which files and commands use, changes only with "Set
scene camera". "Back to scene camera" returns to it.

A scene with frames has a frame slider: the frames of --frames, or from the first to the last key of the scene. Frames
reuse the stages that they share. The final image is that of opaline render --frames. Changing a keyed value sets its
key at the current frame.

Anyone with the URL can edit the scene, upload files and write such files into its folder. The server refuses other requests and
reports them on stderr: a wrong token, Origin or host name, messages above 64 kB, more than 16 pages or 64 connections.
The connection is not encrypted: use --listen only on a trusted network, or use ssh -L 8080:127.0.0.1:8080 and
--port 8080. On a slow connection, a page skips images; the next image is always the newest. A page that loses its
server tries to reconnect. With --port and --token, a new server has the same URL and takes over the page's edits.

Examples:
  opaline view
  opaline view bunny.json
  opaline view bunny.json --set media.marble.specular_ior=1.4 --resolution 1024x1024
  opaline view turn.json --frames 1-24
  opaline view bunny.json --port 8080 --token my-own-long-secret

Exit codes: 0 ended by Ctrl-C, 2 bad input, 3 the port is not available.)";

inline constexpr const char* kCompareNotes =
    R"(The relative error is (a - b) / max(|b|, floor), where floor is 1e-3 times the p99 of |b|. It covers the pixels that
show an object: coverage A > 0 in the reference, or all pixels if the reference has no A.
  mean       mean absolute relative error; --fail-above tests this value
  relMSE     mean squared relative error
  p99, max   99th percentile and maximum of the absolute relative error
  signed     mean signed relative error; positive if the image is too bright
  FLIP       visible difference when flipping between the images, from 0 (none) to 1 (LDR-FLIP, 67 pixels per
             degree), on the sRGB images after --exposure
NaN and infinite values are counted but excluded from the means. Any such value in the image fails the comparison.

--halves takes two references with independent noise (two seeds, for example) and prints an error without the noise of
the references: err^2 = mean of (h - d1)(h - d2) / (d^2 + (0.01 max d)^2), where h is the image, d1 and d2 are the references and d is their mean. A negative
value is 'below noise'. A value below twice its standard error is not significant. Errors common to both halves remain.

Error images: .png shows the largest error over the channels: black (0.01 % or less), violet, red (1 %), orange, white
(100 % or more); grey: no object; green: not finite. .exr stores the signed relative errors.

Examples:
  opaline compare a.exr b.exr --error-picture error.png
  opaline compare a.exr b.exr --layer diffuse --fail-above 1% --json
  opaline compare a.exr --halves seed1.exr seed2.exr

Exit codes: 0 done, 1 above the bound or not finite, 2 bad input, 3 the error image cannot be written.)";

inline constexpr const char* kBenchNotes =
    R"(Runs lambert, hierarchical and direct at several settings for each scene. Each run is a separate process, and repeats
are interleaved. Prints medians, and ratios to lambert (CPU time of the whole job and of the shading pass) within one
round. The CSV stores all results with their minima and maxima, and the machine.

error     rms relative error against two halves of a reference (compare --halves), in the worst channel;
          "< 2" means below 2 %, the noise of the halves
p99       against the mean of the halves; in parentheses, the p99 of the noise of that mean

-o writes a report into a folder. index.html (a local page; it needs no network) shows error against CPU time, images,
error images, and the components of the error, each rendered separately. results.csv, budget.csv and results.json store
the same results. After an interruption, repeat the command: it reuses the finished runs of the same program, scene and
settings. (A ratio may then pair runs from before and after the interruption.)

--profiles measures each translucent scene with each radial profile of its media. Each profile is a separate model with
its own reference; the results do not include the difference between profiles.

--truth renders each translucent scene twice by random walks inside its bodies, on up to 6,000 surface cells, until the
noise is 20 % per cell (some ten seconds of CPU each for a marble bunny, at any resolution). It measures `lambert`, the
scene as given, each radial profile and `volume_diffusion` against both references, under direct light only, without
re-entry. The rows appear as a separate scene. The noise of the random walks is removed as with --halves. The least
measurable error is higher, because neighbouring pixels share the noise of a cell.

--against compares ratios to lambert and errors with an earlier results.json, setting by setting. It exits with 1 if
one is significantly worse: the ranges of a ratio are apart by more than half their combined width, or the squared error
differs by more than three standard errors. Changes below 5 % are ignored.

The bench stores the halves that it renders (--reference-dir) and reuses them while scene, meshes and settings are the
same. Delete them if the implementation of `direct` changes. An interrupted half resumes from its last state.

Examples:
  opaline bench bunny.json -o report --quick
  opaline bench bunny.json ball.json -o report --resolution 256x256 --repeats 5
  opaline bench bunny.json -o new --resolution 256x256 --against report/results.json
  opaline bench bunny.json -o truth --quick --truth
  opaline bench bunny.json --csv bunny.csv --halves seed1.exr seed2.exr --rung near_field=false

Exit codes: 0 done, 1 worse than before (--against), 2 bad input, 3 a run failed (its row states the reason), 130
interrupted.)";

inline constexpr const char* kProfileNotes =
    R"(Traces random walks through a half space or slab with Fresnel refraction and reflection at a smooth boundary. The walks
use no diffusion model; they are the reference for the medium, up to their standard errors. The report compares all
radial profiles with them.

Fractions are relative to the transmitted light; they exclude the reflection at the front face. "shape" is the largest
difference over all distances between two cumulative distributions, each normalized by its own total: the light that
leaves within that distance, by the profile and by random walks, under diffuse light.

-o writes index.html (a local page; it needs no network) and all results as totals.csv, profile.csv (by distance) and
angles.csv (albedo by angle of incidence, radiance by angle of exit).

A medium is a preset, sigma_a and sigma_s_prime, or sigma_a, sigma_s and g, in 1/mm; each value is one number or
[r, g, b]. In a half space without absorption, some walks never end. opaline stops each walk after 16 million
collisions and reports it as unfinished.

--scene FILE reads the medium of this name from a scene. Layers are walked as a stack, at three wavelengths if the scene
has spectra. "layers, normal" is the diffusion equation in the stack for a beam along the normal; "tabulated" is the
radial profile of the stack; the other profiles have the equivalent homogeneous medium.

Examples:
  opaline profile skin1 -o skin
  opaline profile fair --scene scenes/skin-tones.json
  opaline profile marble --thickness 2mm --g 0.8 -o plate
  opaline profile '{"sigma_a": [0.002, 0.004, 0.007], "sigma_s": 22, "g": 0.9, "specular_ior": 1.33}' --walks 1000000

Exit codes: 0 done, 2 bad input, 3 the folder cannot be written, 130 interrupted (an earlier report remains).)";

inline constexpr const char* kCacheNotes =
    R"(An entry stores the result of one stage for one input: the samples of a body, the transmitted irradiance of one light at
these samples, their octree, or the exitance of the surface. The entry's name ends in the key of its input. Entries are
HDF5 files with a header that holds a hash of the content. opaline does not use an entry with a wrong hash; it computes
the result again.

Exit codes: 0 done, 1 an entry is damaged, 2 bad input, 3 the folder cannot be read or written.)";

}  // namespace opaline
