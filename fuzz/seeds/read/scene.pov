#version 3.7; // A scene
#include "colors.inc"
camera { location <0, 2, -8> look_at 0 }
#declare R = 2 + .5; #declare Away = <R, 0, 1e0>*2 - x;
#declare Ball = sphere { 0, R texture { pigment { rgb 1 } } }
difference {
  object { Ball rotate <30, 0, 90> }
  box { -1, 1 scale <1, 2, -3> }
  cylinder { -5*z, 5*z, R/2 inverse }
  translate Away scale 3
}
merge { torus { 3, 1 } cone { 0, 1, y, .5 no_shadow } }
