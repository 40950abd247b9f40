// A flat tensile specimen with an off-centre hole, in millimetres.
// Make the mesh with: gmsh -3 tensile_bar.geo -format msh41 -bin -o tensile_bar.msh
SetFactory("OpenCASCADE");

total = 120;       // overall length
grip_width = 20;
gauge_width = 10;
gauge_length = 60; // parallel part
fillet = 12;       // radius from gauge to grip
thickness = 4;
grip = 20;         // length held by the machine at each end
hole = 1.8;        // radius
hole_x = 5;
hole_y = 1.2;

// The outline is cut from a plate by two pockets with rounded ends.
Box(1) = {-total/2, -grip_width/2, 0, total, grip_width, thickness};
depth = (grip_width - gauge_width) / 2;
For side In {-1:1:2}
  Box(newv) = {-gauge_length/2, side > 0 ? gauge_width/2 : -grip_width/2 - 1, -1,
               gauge_length, depth + 1, thickness + 2};
  For end In {-1:1:2}
    Cylinder(newv) = {end*gauge_length/2, side*(gauge_width/2 + fillet), -1, 0, 0, thickness + 2, fillet};
  EndFor
EndFor
Cylinder(newv) = {hole_x, hole_y, -1, 0, 0, thickness + 2, hole};
cutters[] = Volume{:};
cutters[] -= {1};
bar[] = BooleanDifference{ Volume{1}; Delete; }{ Volume{cutters[]}; Delete; };

// Three parts that share their faces.
Box(101) = {-total/2, -grip_width, -1, grip, 2*grip_width, thickness + 2};
Box(102) = {total/2 - grip, -grip_width, -1, grip, 2*grip_width, thickness + 2};
left[] = BooleanIntersection{ Volume{bar[]}; }{ Volume{101}; Delete; };
right[] = BooleanIntersection{ Volume{bar[]}; }{ Volume{102}; Delete; };
middle[] = BooleanDifference{ Volume{bar[]}; Delete; }{ Volume{left[], right[]}; };
Coherence;

e = 0.01;
grip_left[] = Volume In BoundingBox{-total/2 - e, -grip_width, -e, -total/2 + grip + e, grip_width, thickness + e};
grip_right[] = Volume In BoundingBox{total/2 - grip - e, -grip_width, -e, total/2 + e, grip_width, thickness + e};
gauge[] = Volume{:};
gauge[] -= {grip_left[], grip_right[]};
Physical Volume("grip_left", 1) = grip_left[];
Physical Volume("gauge", 2) = gauge[];
Physical Volume("grip_right", 3) = grip_right[];

// Fine round the hole and in the gauge, coarse in the grips.
Field[1] = MathEval;
Field[1].F = Sprintf("1.4 + 1.0*Max(0, Abs(x) - %g)/%g", 22, 20);
Field[2] = MathEval;
Field[2].F = Sprintf("0.8 + 0.16*Max(0, Sqrt((x-%g)^2 + (y-%g)^2) - %g)", hole_x, hole_y, hole);
Field[3] = Min;
Field[3].FieldsList = {1, 2};
Background Field = 3;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
