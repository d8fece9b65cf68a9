// The choice of a light at a point, by the way that the plan chose: by cells of lights, by a tree, or by power alone. Each of them has
//
//   LightContext                                 what the choice knows of a point of a surface
//   light_context(point, facing)                 the surface faces the way that `facing_of` says
//   choose_light(context, bits)                  the light that 32 random bits choose
//   light_pmf(context, light)                    the probability of that, for a light inside the scene
//   distant_light_pmf(context, light)            the probability of that, for a light at infinity
#if LIGHT_CELLS
#export shading/light/choice/cells.wgsl
#else
#if LIGHT_TREE
#export shading/light/choice/tree.wgsl
#else
#export shading/light/choice/power.wgsl
#endif
#endif
