// SPDX-License-Identifier: GPL-3.0-or-later
// What --help prints below the options.
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
  opaline render bunny.json -o reference.exr --method direct --until-error 2% --resume sums.exr
  opaline render bunny.json -o bunny.exr --log json --threads 4
  opaline compare bunny.exr reference.exr --fail-above 1%
  opaline bench bunny.json -o report --resolution 256x256
  opaline profile marble -o marble
  opaline render bunny.json -o turned.exr --cache stages --set camera.position=[0,50,200]
  opaline render bunny.json -o out.####.exr --frames 1-24 --cache stages
  opaline cache ls stages

Exit codes: 0 done, 1 a comparison failed, 2 bad input, 3 the run failed (I/O, memory), 130 interrupted (Ctrl-C; old files stay).)";

inline constexpr const char* kRenderNotes = R"(Every option that changes the picture is short for a --set:
  --spp 4            --set film.samples_per_pixel=4
  --resolution 64x48 --set film.resolution=[64,48]
  --crop 0,0,16,16   --set film.crop=[0,0,16,16]
  --method, --evaluator, --seed, --entry-samples, --until-error: --set settings.<name>=...
  --exposure, --view: --set film.<name>=...
They are applied first, then each --set in its order: the last one wins.

--target-error is the mean relative error of the diffuse light over the translucent pixels, of the worst channel,
against the converged --method direct. What the diffusion model itself is off by is not in it, nor what --spp
does to edges: that stays yours. A small picture estimates its own error; where that is too much it is made again
with more samples. --verify measures what came of it, at a cost that grows with the square of the accuracy. The
closing line "again by" is a command that makes the same pixels and chooses nothing. With
--frames it holds for settings.reference_frame: settings are chosen there, once, and all frames share them, so that
nothing flickers. With --method volume_diffusion it is the error against --method volume without settings.reenter,
the model's own included: a bound of what the plan expects of it. Where that alone is more, a warning says the least
that can be promised, which is taken.

--time-budget is the CPU time of the whole program, all threads, user and system, as the closing table has it: its
start, loading, choosing and writing are within, --verify is not. Small pictures, tiles of the whole one and small
files tell what samples cost and bring; as many are taken as there is time for, up to settings.max_samples. Where
even the cheapest picture takes longer it is made, and a warning says how long. Pixels, --spp and
settings.light_samples stay yours. What is chosen depends on the clock; "again by" does not. With --method direct it
is when to stop.)";

inline constexpr const char* kImportNotes =
    R"(Other commands take an asset wherever they take a scene file: what they see is what is written here. Each line
on stderr says what became of a value, or what is not carried over.

  glTF    meshes, nodes, skins at rest, morph targets by their weights, cameras, lights (KHR_lights_punctual)
          and materials. A material that scatters
          (KHR_materials_volume with KHR_materials_volume_scatter or KHR_materials_scatter) becomes a medium of
          sigma_a and sigma_s in 1/mm; all others are opaque, of their base colour, metalness, roughness and specularFactor. So are
          their textures, in the file or beside it; samplers are passed over. Lengths are metres.
          A candela is drawn as 1e6 W/sr and a lux as 1 W/mm^2; the PNG's exposure suits the brightness.
  .mtlx   the constants of open_pbr_surface and standard_surface: where they scatter below the surface, a medium of
          subsurface_color and subsurface_radius, whose lengths are in the asset's unit; else opaque, of their base
          colour, metalness and coat.
  OBJ     meshes, a shape for each usemtl, with the Kd and map_Kd of its MTL. Lengths are taken for millimetres.
  PLY, STL, OFF   one opaque shape, grey or of its vertex colours. Lengths are taken for millimetres.

Files that an asset names lie in its folder, or below; others, also behind links, are refused unless --allow-outside
is given. Where a name leads nowhere, as a path of another machine does, the file of that name beside is taken.

Without a camera the picture is a three-quarter view of the whole, without lights there are a key, a fill and a rim
light around it, placed for the camera and unseen by it.

Examples:
  opaline import statue.glb -o statue.json
  opaline render statue.glb -o statue.png
  opaline import bunny.obj --material skin.mtlx#SR_skin -o bunny.json

Exit codes: 0 done, 2 the asset is broken, 3 the scene file cannot be written.)";

inline constexpr const char* kViewNotes =
    R"(Prints a URL, and on a terminal of a desktop opens it in the browser (by xdg-open). Open it on this machine in as many
windows as you like: all see and edit the same. Nothing is installed or loaded from elsewhere. Every change
shows a coarse picture at once, then a sharper one, and then the final one, with the bits of opaline render; a newer
change cancels it. Ctrl-C ends the view.

The scene file stays as it is: "save" writes another one beside it, "render" a picture, by names of your choice that
are not taken. Mesh files are those of the scene.

Orbit, pan and dolly move a free camera of the view. The scene's own, which files and commands have, stays until "Set
scene camera" moves it there; "Back to scene camera" ends the free one.

A scene with frames has a slider for them: those of --frames, or from the first key of its values to the last. What frames
share is not computed again. A final picture is then that of opaline render --frames. Changing a value that has keys
sets its key at the frame shown.

Who has the URL can edit, and write such files into the scene's folder. Other requests are refused, with a line on
stderr: another token, Origin or host name, messages above 64 kB, more than 16 pages or 64 connections. What is
sent is not encrypted: with --listen, trust the network, or use ssh -L 8080:127.0.0.1:8080 and --port 8080.
Over a slow connection a page skips pictures: the next one sent is always the newest.
A page that lost its server tries again; with --port and --token the next server is at the same URL, and takes over
the page's edits.

Examples:
  opaline view bunny.json
  opaline view bunny.json --set media.marble.specular_ior=1.4 --resolution 1024x1024
  opaline view turn.json --frames 1-24
  opaline view bunny.json --port 8080 --token my-own-long-secret

Exit codes: 0 ended by Ctrl-C, 2 bad input, 3 the port cannot be had.)";

inline constexpr const char* kCompareNotes =
    R"(Figures are of the relative error (a - b) / max(|b|, floor), floor being 1e-3 of the p99 of |b|, over the
pixels that show an object: coverage A > 0 in the reference, or all of them if it has no A.
  mean       of the absolute relative error; this is what --fail-above looks at
  relMSE     mean of its square
  p99, max   what 99 % and all of the values do not exceed
  signed     mean with the sign: above 0 where the picture is too bright
  FLIP       what a person sees who flips between the two: 0 nothing, 1 all (LDR-FLIP, 67 pixels a degree),
             on the sRGB pictures after --exposure
NaN and infinities are counted, and enter no mean; any in the picture fails the comparison.

--halves takes two references with independent noise, such as two seeds, and prints the error that their noise
does not raise: err^2 = mean of (h - d1)(h - d2) / (d^2 + (.01 max d)^2), d the mean of both. Below 0 it is
'below noise'; not above twice its standard error it says nothing. What is wrong with both halves stays.

Error pictures: .png shows the largest error over the channels from black (.01 % or less) over violet, red (1 %)
and orange to white (100 % or more); grey: no object; green: not finite. .exr holds the signed relative errors.

Examples:
  opaline compare a.exr b.exr --error-picture error.png
  opaline compare a.exr b.exr --layer diffuse --fail-above 1% --json
  opaline compare a.exr --halves seed1.exr seed2.exr

Exit codes: 0 done, 1 above the bound or not finite, 2 bad input, 3 the error picture cannot be written.)";

inline constexpr const char* kBenchNotes =
    R"(For each scene: lambert, hierarchical and direct at several settings, each run a process of its own, the
repeats of all taking turns. Prints medians, and ratios to lambert (CPU of the whole job, of the shading pass)
of one round each; the CSV has all figures with their smallest and largest values, and the machine.

error     rms relative error against two halves of a reference (compare --halves), worst channel;
          "< 2": what could be told from the noise of the halves begins at 2 %
p99       against the mean of the halves; in brackets the p99 of that mean's own noise

-o writes a report into a folder: index.html (open it in a browser; no network is needed) with the trade of
error against CPU time, pictures and where they are off, and the parts of the error, each rendered alone; the
same figures as results.csv, budget.csv and results.json; pictures. Run it again after an interruption: what
this program has finished on the same scene and settings is kept there and not repeated (a ratio then may pair
runs from before and after).

--profiles measures each translucent scene once with each radial profile of its media. A profile is a model of its
own: each has its own reference, and what one differs from the other by is in no figure.

--truth renders each translucent scene twice by random walks inside its bodies, on up to 6000 cells of the surface,
until 20 % of a cell (some ten seconds of CPU each for a bunny in marble, whatever the resolution). Against both it holds
`lambert`, the scene as it is, each radial profile and `volume_diffusion`, all lit by lights alone; light that has left
a body is gone. Their rows are those of one more scene. The noise of the walks is taken out as that of halves is; what
can be told from it begins higher, as neighbouring pixels share it.

--against compares ratios to lambert and errors with an earlier results.json, rung by rung, and exits with 1 if
one is worse beyond the noise: the ranges of a ratio lie apart by more than half their widths together, an
error's square by more than three of its standard errors; less than 5 % is never a change.

Halves that the bench renders are kept (--reference-dir) and used again while scene, meshes and settings are
the same; delete them when `direct` itself has changed. An interrupted one goes on where it stopped.

Examples:
  opaline bench bunny.json -o report --quick
  opaline bench bunny.json ball.json -o report --resolution 256x256 --repeats 5
  opaline bench bunny.json -o new --resolution 256x256 --against report/results.json
  opaline bench bunny.json -o truth --quick --truth
  opaline bench bunny.json --csv bunny.csv --halves seed1.exr seed2.exr --rung near_field=false

Exit codes: 0 done, 1 worse than before (--against), 2 bad input, 3 a rung failed (its row says why) or the run
did, 130 interrupted.)";

inline constexpr const char* kProfileNotes =
    R"(Random walks follow light through a flat half space or slab, with refraction and reflection at a smooth
boundary: they know no diffusion model, and are the truth of the medium but for their error bars. Beside them
stand all radial profiles that scenes can use.

Shares are of the light that entered; what the face reflects before is in none. "shape" is the largest difference,
over all distances, of the shares (each of its own total) that leave within that distance, against diffuse light.

-o writes index.html (open it in a browser; no network is needed) and every figure as totals.csv, profile.csv (by
distance) and angles.csv (albedo by angle of entry, radiance by angle of exit).

A medium is given by a preset, by sigma_a and sigma_s_prime, or by sigma_a, sigma_s and g, in 1/mm; one number or
[r, g, b]. Where nothing absorbs in a half space some walks would take forever: what is still inside after 16 million
collisions is told as unfinished.

Examples:
  opaline profile skin1 -o skin
  opaline profile marble --thickness 2mm --g .8 -o plate
  opaline profile '{"sigma_a": [0.002, 0.004, 0.007], "sigma_s": 22, "g": 0.9, "specular_ior": 1.33}' --walks 1000000

Exit codes: 0 done, 2 bad input, 3 the folder cannot be written, 130 interrupted (the old report stays).)";

inline constexpr const char* kCacheNotes =
    R"(An entry holds the result of one stage for one input: the samples of a group, the light that enters
them from one light, their tree, or the exitance all over their surfaces. Its name ends in the key of that input. Entries are HDF5 files behind a
header with a hash of the rest; one that does not match it is never read, but computed again.

Exit codes: 0 done, 1 an entry cannot be used, 2 bad input, 3 the folder cannot be read or written.)";

}  // namespace opaline
