// closest_hit and transmittance, wherever the plan put the geometry.
#if BVH
#export geometry/traversal.wgsl
#else
#if RAY_QUERY
#export geometry/ray_query.wgsl
#else
#export geometry/unrolled.wgsl
#endif
#endif
