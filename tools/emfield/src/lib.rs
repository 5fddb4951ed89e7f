//! Weighted least squares meshfree electrostatic and eddy-current fields.
